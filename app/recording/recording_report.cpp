#include "app/recording/recording_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <ranges>
#include <utility>

#include "app/recording/recorded_cell.hpp"
#include "ipc/record/summary.hpp"
#include "rt_core/base/shell_word.hpp"
#include "rt_core/base/text.hpp"
#include "rt_core/base/utc_text.hpp"

namespace cellmirror::app {

namespace {

using nlohmann::json;

constexpr std::size_t kLongestTopic = 48;

std::string dumped(const json& document) { return document.dump(2, ' ', false, json::error_handler_t::replace) + "\n"; }

double duration_s(const mcap::Statistics& statistics) {
  return statistics.end_time > statistics.start_time
             ? 1e-9 * static_cast<double>(statistics.end_time - statistics.start_time)
             : 0.0;
}

double rate_hz(std::uint64_t messages, double duration) {
  return duration > 0 && messages > 1 ? static_cast<double>(messages - 1) / duration : 0.0;
}

std::uint64_t messages_of(const mcap::Statistics& statistics, std::uint16_t channel) {
  const auto found = statistics.channel_messages.find(channel);
  return found == statistics.channel_messages.end() ? 0 : found->second;
}

std::uint64_t drops_of(const std::optional<mcap::Metadata>& drops, const std::string& topic) {
  if (!drops) return 0;
  const auto found = drops->values.find(topic);
  if (found == drops->values.end()) return 0;
  const auto number = parse_integer(found->second);
  return number && *number > 0 ? static_cast<std::uint64_t>(*number) : 0;
}

std::string utc(std::uint64_t ns) {
  return utc_text_ms(static_cast<std::int64_t>(std::min<std::uint64_t>(ns, INT64_MAX)));
}

// By topic.
std::vector<const mcap::Channel*> sorted_channels(const mcap::Catalogue& catalogue) {
  std::vector<const mcap::Channel*> out;
  for (const auto& [id, channel] : catalogue.channels) out.push_back(&channel);
  std::ranges::stable_sort(out, {}, [](const mcap::Channel* channel) { return channel->topic; });
  return out;
}

std::string schema_name(const mcap::Catalogue& catalogue, const mcap::Channel& channel) {
  const mcap::Schema* schema = catalogue.schema_of(channel);
  return schema == nullptr ? std::string() : schema->name;
}

json statistics_json(const mcap::Statistics& statistics) {
  return {{"messages", statistics.messages},       {"channels", statistics.channels},
          {"schemas", statistics.schemas},         {"chunks", statistics.chunks},
          {"attachments", statistics.attachments}, {"metadata", statistics.metadata}};
}

std::string compressions_of(const mcap::Reader& reader) {
  std::vector<std::string> seen;
  for (const mcap::ChunkIndex& chunk : reader.chunks()) {
    std::string word = chunk.compression.empty() ? "none" : printable(chunk.compression, 16);
    if (std::ranges::find(seen, word) == seen.end()) seen.push_back(std::move(word));
    if (seen.size() > 3) break;
  }
  return seen.empty() ? std::string("none") : fmt::format("{}", fmt::join(seen, ", "));
}

std::uint64_t uncompressed_bytes(const mcap::Reader& reader) {
  std::uint64_t out = 0;
  for (const mcap::ChunkIndex& chunk : reader.chunks()) out += chunk.uncompressed_size;
  return out;
}

json faults_json(const mcap::Faults& faults) {
  json out = json::array();
  for (const mcap::Fault& fault : faults.first()) out.push_back({{"offset", fault.offset}, {"what", fault.what}});
  return out;
}

std::string faults_text(const mcap::Faults& faults) {
  std::string out;
  for (const mcap::Fault& fault : faults.first()) out += fmt::format("at byte {}: {}\n", fault.offset, fault.what);
  if (faults.count() > faults.first().size())
    out += fmt::format("and {} more\n", faults.count() - faults.first().size());
  return out;
}

constexpr std::size_t kMostMissingTold = 20;

std::string cell_text(const mcap::Reader& reader) {
  const RecordedCell cell = recorded_cell(reader);
  if (cell.cell_file.empty()) return {};
  if (cell.complete())
    return fmt::format("cell files: complete, {} with {}\n", cell.files.size(), printable(cell.cell_file));
  std::string out = fmt::format("cell files: NOT complete, {} are missing\n", cell.missing.size());
  for (const std::string& one : cell.missing | std::views::take(kMostMissingTold))
    out += fmt::format("  {}\n", printable(one));
  return out;
}

json cell_json(const mcap::Reader& reader) {
  const RecordedCell cell = recorded_cell(reader);
  if (cell.cell_file.empty()) return nullptr;
  return {
      {"file", cell.cell_file}, {"files", cell.files.size()}, {"complete", cell.complete()}, {"missing", cell.missing}};
}

}  // namespace

std::string recover_command(const std::string& file) {
  const std::string_view stem = std::string_view(file).substr(0, file.size() - (file.ends_with(".mcap") ? 5 : 0));
  return fmt::format("cellmirror recording recover {} -o {}", shell_word(file),
                     shell_word(fmt::format("{}-repaired.mcap", stem)));
}

std::string recording_info_text(const std::string& file, std::uint64_t bytes, const mcap::Reader& reader) {
  const mcap::Statistics& statistics = reader.statistics();
  const double duration = duration_s(statistics);
  std::string out =
      fmt::format("{}: {:.3f} s from {}, {} messages, {:.1f} MB ({}), profile {}, by {}\n", file, duration,
                  utc(statistics.start_time), statistics.messages, 1e-6 * static_cast<double>(bytes),
                  compressions_of(reader), printable(reader.header().profile), printable(reader.header().library));
  if (const auto gateway = reader.metadata(kGatewayName)) {
    for (const auto& [key, value] : gateway->values) out += fmt::format("  {}: {}\n", printable(key), printable(value));
  }
  if (!reader.indexed())
    out += fmt::format("no summary is used: {}; write a file with one: {}\n", reader.why_not_indexed(),
                       recover_command(file));
  if (reader.chunks_left_out() > 0) {
    out += fmt::format(
        "{} of {} chunks are not counted: all chunks together have {:.1f} GB decompressed; if you trust the origin of "
        "the file, read them with: --decompressed-limit {:.0f}\n",
        reader.chunks_left_out(), reader.chunks().size(), 1e-9 * static_cast<double>(uncompressed_bytes(reader)),
        std::ceil(1e-9 * static_cast<double>(uncompressed_bytes(reader))));
  }
  const auto drops = reader.metadata(kDropsName);
  out += fmt::format("\n{:<{}} {:>10} {:>9} {:>9}  {}\n", "topic", kLongestTopic, "messages", "Hz", "dropped", "type");
  for (const mcap::Channel* channel : sorted_channels(reader.catalogue())) {
    const std::uint64_t messages = messages_of(statistics, channel->id);
    out += fmt::format("{:<{}} {:>10} {:>9.1f} {:>9}  {} ({})\n", printable(channel->topic, kLongestTopic),
                       kLongestTopic, messages, rate_hz(messages, duration), drops_of(drops, channel->topic),
                       printable(schema_name(reader.catalogue(), *channel)), printable(channel->encoding));
  }
  for (const mcap::AttachmentIndex& attachment : reader.attachments())
    out += fmt::format("attachment {}: {} bytes, {}\n", printable(attachment.name), attachment.data_size,
                       printable(attachment.media_type));
  return out + cell_text(reader);
}

std::string recording_info_json(const std::string& file, std::uint64_t bytes, const mcap::Reader& reader) {
  const mcap::Statistics& statistics = reader.statistics();
  const double duration = duration_s(statistics);
  const auto drops = reader.metadata(kDropsName);
  json topics = json::array();
  for (const mcap::Channel* channel : sorted_channels(reader.catalogue())) {
    const std::uint64_t messages = messages_of(statistics, channel->id);
    topics.push_back({{"topic", channel->topic},
                      {"type", schema_name(reader.catalogue(), *channel)},
                      {"encoding", channel->encoding},
                      {"messages", messages},
                      {"rate_hz", rate_hz(messages, duration)},
                      {"dropped", drops_of(drops, channel->topic)}});
  }
  json attachments = json::array();
  for (const mcap::AttachmentIndex& attachment : reader.attachments())
    attachments.push_back(
        {{"name", attachment.name}, {"bytes", attachment.data_size}, {"media_type", attachment.media_type}});
  json out = {{"file", file},
              {"bytes", bytes},
              {"uncompressed_bytes", uncompressed_bytes(reader)},
              {"compression", compressions_of(reader)},
              {"profile", reader.header().profile},
              {"library", reader.header().library},
              {"start_utc", utc(statistics.start_time)},
              {"start_ns", statistics.start_time},
              {"end_ns", statistics.end_time},
              {"duration_s", duration},
              {"indexed", reader.indexed()},
              {"why_not_indexed", reader.why_not_indexed()},
              {"chunks_left_out", reader.chunks_left_out()},
              {"topics", std::move(topics)}};
  out.update(statistics_json(statistics));
  out["attachments"] = std::move(attachments);
  out["cell"] = cell_json(reader);
  const auto gateway = reader.metadata(kGatewayName);
  out["gateway"] = gateway ? json(gateway->values) : json(nullptr);
  return dumped(out);
}

Result<RecordingCheck> check_recording(const mcap::Source& source, const mcap::Limits& limits) {
  mcap::Visitor nothing;
  auto scanned = mcap::scan(source, limits, nothing);
  if (!scanned) return std::unexpected(scanned.error());
  RecordingCheck out{*std::move(scanned), {}, source.size()};
  // The summary of a joined file is that of its last recording.
  if (out.scan.recordings > 1) return out;
  const auto summary = mcap::read_summary(source, limits);
  if (!summary) {
    out.summary_faults.add(source.size(), summary.error().what);
    return out;
  }
  const std::uint64_t at = summary->footer.summary_start;
  if (summary->statistics && *summary->statistics != out.scan.statistics) {
    out.summary_faults.add(at, fmt::format("the summary counts {} messages in {} chunks; there are {} in {}",
                                           summary->statistics->messages, summary->statistics->chunks,
                                           out.scan.statistics.messages, out.scan.statistics.chunks));
  }
  if (summary->chunks.empty()) return out;
  const auto offset_of = [](const mcap::ChunkIndex& chunk) { return std::pair(chunk.offset, chunk.length); };
  if (!std::ranges::is_permutation(summary->chunks, out.scan.chunks, {}, offset_of, offset_of))
    out.summary_faults.add(at, "the summary names other chunks than there are");
  return out;
}

std::string recording_check_text(const std::string& file, const RecordingCheck& check) {
  std::string out = faults_text(check.scan.faults) + faults_text(check.summary_faults);
  const mcap::Statistics& statistics = check.scan.statistics;
  out += fmt::format("{}: {}; {} messages in {} chunks, {} attachments are whole", file,
                     check.whole() ? "whole" : "NOT whole", statistics.messages, statistics.chunks,
                     statistics.attachments);
  if (check.scan.chunks_lost > 0) out += fmt::format(", {} chunks are lost", check.scan.chunks_lost);
  if (check.scan.out_of_order > 0) out += fmt::format(", {} messages are out of order", check.scan.out_of_order);
  if (!check.scan.ended) out += fmt::format("; it breaks off at byte {} of {}", check.scan.whole_until, check.bytes);
  return out + "\n";
}

std::string recording_check_json(const std::string& file, const RecordingCheck& check) {
  json out = {{"file", file},
              {"bytes", check.bytes},
              {"whole", check.whole()},
              {"ended", check.scan.ended},
              {"whole_until", check.scan.whole_until},
              {"chunks_lost", check.scan.chunks_lost},
              {"out_of_order", check.scan.out_of_order},
              {"fault_count", check.scan.faults.count() + check.summary_faults.count()},
              {"faults", faults_json(check.scan.faults)},
              {"summary_faults", faults_json(check.summary_faults)}};
  out.update(statistics_json(check.scan.statistics));
  return dumped(out);
}

}  // namespace cellmirror::app
