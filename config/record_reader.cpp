#include "config/record_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

constexpr std::size_t kMostTopics = 64;
constexpr double kShortestFile_s = 1;
constexpr double kLongest_s = 7 * 86'400;
constexpr std::size_t kMostFilesOfRing = 1000;

void read_keep_on(TableReader& table, RecordSettings& settings) {
  const auto words = table.texts("keep_on");
  if (!words) return;
  settings.keep_on_fault = std::ranges::find(*words, "fault") != words->end();
  settings.keep_on_collision = std::ranges::find(*words, "collision") != words->end();
  for (const std::string& word : *words) {
    if (word != "fault" && word != "collision")
      table.error("keep_on", fmt::format("\"{}\" is not an event that keeps a recording", printable(word)),
                  "known: fault, collision");
  }
}

void read_pictures(TableReader& table, RecordSettings& settings) {
  const auto texts = table.texts("pictures");
  if (!texts) return;
  if (texts->size() > kMostRecordedPictures)
    table.error("pictures", fmt::format("more than {} views", kMostRecordedPictures));
  for (const std::string& text : *texts) {
    auto picture = recorded_picture(text);
    if (!picture) {
      table.error("pictures", fmt::format("\"{}\" is not a view with a rate", printable(text)),
                  "write a view (0 to 6) or a camera, @ and 0.01 to 10 Hz, as \"1@0.5\"");
    } else if (std::ranges::find(settings.pictures, picture->view, &RecordedPicture::view) != settings.pictures.end()) {
      table.error("pictures", fmt::format("the view {} occurs twice", printable(picture->view)));
    } else {
      settings.pictures.push_back(*std::move(picture));
    }
  }
}

}  // namespace

std::optional<RecordedPicture> recorded_picture(std::string_view text) {
  constexpr double kLeast_hz = 0.01;
  constexpr double kMost_hz = 10;
  constexpr std::size_t kLongestPictureName = 255;
  const std::size_t at = text.rfind('@');
  if (at == std::string_view::npos || at == 0 || at > kLongestPictureName) return std::nullopt;
  const auto rate = parse_number(text.substr(at + 1));
  if (!rate || !(*rate >= kLeast_hz && *rate <= kMost_hz)) return std::nullopt;
  return RecordedPicture{std::string(text.substr(0, at)), *rate};
}

RecordSettings read_record(TableReader& top) {
  RecordSettings settings;
  auto table = top.table("record");
  if (!table) return settings;
  settings.present = true;
  settings.enabled = table->boolean("enabled").value_or(true);
  settings.length_s = table->number("length_s", {kShortestFile_s, kLongest_s}).value_or(settings.length_s);
  settings.file_s =
      table->number("file_s", {kShortestFile_s, kLongest_s}).value_or(std::min(settings.file_s, settings.length_s));
  if (settings.file_s > settings.length_s || settings.length_s / settings.file_s > kMostFilesOfRing)
    table->error("file_s", "a ring has 1 to 1000 files", "give a file_s between length_s / 1000 and length_s");
  settings.most_mb = static_cast<std::uint64_t>(table->integer("most_mb", 1, 1'000'000).value_or(1024));
  settings.attach_mb = static_cast<std::uint64_t>(table->integer("attach_mb", 0, 1024).value_or(64));
  settings.keep_after_s = table->number("keep_after_s", {0.0, 600.0}).value_or(settings.keep_after_s);
  settings.rate_hz = table->number("rate_hz", {0.1, 4000.0}).value_or(settings.rate_hz);
  settings.tissue_rate_hz = table->number("tissue_rate_hz", {0.0, 30.0}).value_or(settings.tissue_rate_hz);
  settings.compression = table->choice<std::string>("compression", {{"zstd", "zstd"}, {"lz4", "lz4"}, {"none", "none"}})
                             .value_or(settings.compression);
  settings.topics = table->texts("topics").value_or(settings.topics);
  if (settings.topics.size() > kMostTopics) table->error("topics", "more than 64 topics", "use \"/cellmirror/*\"");
  read_pictures(*table, settings);
  read_keep_on(*table, settings);
  table->finish();
  return settings;
}

}  // namespace cellmirror
