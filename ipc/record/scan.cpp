#include "ipc/record/scan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "ipc/record/decode.hpp"
#include "ipc/record/joined_ids.hpp"
#include "ipc/record/record_finder.hpp"
#include "ipc/record/summary.hpp"

namespace cellmirror::mcap {

std::string Catalogue::add(Schema schema) {
  const auto [known, is_new] = schemas.try_emplace(schema.id, schema);
  if (is_new || known->second == schema) return {};
  return fmt::format("the schema {} is described twice, differently", schema.id);
}

std::string Catalogue::add(Channel channel) {
  const bool without_schema = channel.schema != 0 && !schemas.contains(channel.schema);
  const auto [known, is_new] = channels.try_emplace(channel.id, channel);
  if (!is_new && known->second != channel)
    return fmt::format("the channel {} is described twice, differently", channel.id);
  if (without_schema)
    return fmt::format("the channel {} has a schema {} that is not there", channel.id, channel.schema);
  return {};
}

const Schema* Catalogue::schema_of(const Channel& channel) const {
  const auto found = schemas.find(channel.schema);
  return found == schemas.end() ? nullptr : &found->second;
}

Result<View> ChunkOpener::open(const Chunk& chunk) {
  if (chunk.uncompressed_size > limits_.chunk_bytes) {
    return fail(fmt::format("the chunk would have {} bytes decompressed, more than the {} that are accepted",
                            chunk.uncompressed_size, limits_.chunk_bytes));
  }
  const bool compressed = !chunk.compression.empty();
  exhausted_ = compressed && chunk.uncompressed_size > left_;
  if (exhausted_) {
    return fail(
        fmt::format(
            "the chunks up to here have more than {:.1f} GB decompressed, which is the limit for a file of {:.1f} MB",
            1e-9 * static_cast<double>(limits_.most_decompressed(file_bytes_)),
            1e-6 * static_cast<double>(file_bytes_)),
        "if you trust the origin of the file, raise the limit: --decompressed-limit GB");
  }
  if (compressed) left_ -= chunk.uncompressed_size;
  auto content = decompressor_.decompress(chunk.compression, chunk.records, chunk.uncompressed_size);
  if (!content) return content;
  if (chunk.uncompressed_crc != 0 && chunk.uncompressed_crc != crc32(*content))
    return fail("the CRC of the chunk is wrong");
  return content;
}

namespace {

class Scanner {
 public:
  Scanner(const Source& source, const Limits& limits, Visitor& visitor)
      : source_(source),
        limits_(limits),
        visitor_(visitor),
        opener_(limits, source.size()),
        stream_(source, kMagic.size(), source.size(), limits),
        finder_(source, limits) {}

  Result<ScanReport> run();

 private:
  // Up to the end of the last recording or to the first byte that is not a record; true at the end.
  bool run_records();
  // Goes on at what was found; false where nothing was found.
  bool go_on_at(const std::optional<FoundRecord>& found);
  // Goes on within the record that was taken last where its length cannot be trusted.
  void look_into_suspect(const RecordView& record);
  // Schemas and channels of the summary, because those of the data may be in the damage.
  void take_catalogue_of_summary();
  void begin_recording(std::uint64_t offset);
  // True where no other recording follows.
  bool end_recording(const RecordView& data_end);
  // Behind the footer and the magic of the recording; none where they are not there.
  std::optional<std::uint64_t> end_of_summary(const RecordView& data_end);
  void take(const RecordView& record);
  void take_chunk(const RecordView& record);
  // Handles a chunk beyond the limit of decompressed bytes.
  void refuse_or_leave_out(const Chunk& chunk, const RecordView& record, const Error& why);
  void take_message(Message message, std::uint64_t offset);
  // Of the data section or a chunk; false: it is none of these kinds.
  bool take_inner(const RecordView& record, std::uint64_t offset);
  void look_at_end(std::uint64_t offset);
  template <class... Args>
  void fault(std::uint64_t offset, fmt::format_string<Args...> what, Args&&... args) {
    if (in_chunk_) out_.chunks_have_all = false;
    if (out_.faults.full()) return out_.faults.add_another();
    out_.faults.add(offset, fmt::format(what, std::forward<Args>(args)...));
  }

  const Source& source_;
  Limits limits_;
  Visitor& visitor_;
  ChunkOpener opener_;
  ScanReport out_;
  RecordStream stream_;
  RecordFinder finder_;
  JoinedIds ids_;
  enum class Suspect : std::uint8_t { nothing, record, joined_recording };
  Suspect suspect_ = Suspect::nothing;  // what may begin within the record that was taken last
  std::uint64_t suspect_bytes_ = 0;
  bool summary_taken_ = false;
  std::uint64_t last_time_ = 0;
  bool in_chunk_ = false;
  std::set<std::uint16_t> chunk_channels_;
  bool has_header_ = false;
  bool joined_ = false;           // in another recording than the first
  std::optional<Error> refused_;  // set: the scan ends with this error
};

void Scanner::take_message(Message message, std::uint64_t offset) {
  const auto id = ids_.channel(message.channel);
  const auto channel = id ? out_.catalogue.channels.find(*id) : out_.catalogue.channels.end();
  if (channel == out_.catalogue.channels.end())
    return fault(offset, "a message of the channel {}, which is not described", message.channel);
  message.channel = *id;
  if (message.log_time < last_time_) ++out_.out_of_order;
  last_time_ = message.log_time;
  if (in_chunk_) {
    chunk_channels_.insert(message.channel);
  } else {
    ++out_.messages_outside;
    out_.chunks_have_all = false;
  }
  out_.statistics.count(message);
  visitor_.on_message(message, channel->second);
}

bool Scanner::take_inner(const RecordView& record, std::uint64_t offset) {
  if (record.is(Opcode::schema)) {
    auto schema = decode_schema(record.content);
    if (!schema) suspect_ = Suspect::record;
    const std::string wrong = schema ? ids_.add(*schema, out_.catalogue) : "a schema that is cut off, or has the id 0";
    if (!wrong.empty()) {
      fault(offset, "{}", wrong);
    } else {
      visitor_.on_schema(*schema);
    }
    return true;
  }
  if (record.is(Opcode::channel)) {
    auto channel = decode_channel(record.content);
    if (!channel) suspect_ = Suspect::record;
    const std::string wrong = channel ? ids_.add(*channel, out_.catalogue) : "a channel that is cut off";
    if (!wrong.empty()) {
      fault(offset, "{}", wrong);
    } else {
      visitor_.on_channel(*channel);
    }
    return true;
  }
  if (record.is(Opcode::message)) {
    if (const auto message = decode_message(record.content)) {
      take_message(*message, offset);
    } else {
      suspect_ = Suspect::record;
      fault(offset, "a message that is cut off");
    }
    return true;
  }
  return false;
}

ChunkIndex index_of(const Chunk& chunk, const RecordView& record) {
  ChunkIndex index;
  index.start_time = chunk.start_time;
  index.end_time = chunk.end_time;
  index.offset = record.offset;
  index.length = kRecordHead + record.content.size();
  index.compression = chunk.compression;
  index.compressed_size = chunk.records.size();
  index.uncompressed_size = chunk.uncompressed_size;
  return index;
}

void Scanner::refuse_or_leave_out(const Chunk& chunk, const RecordView& record, const Error& why) {
  out_.chunks_have_all = false;
  if (!limits_.leave_out_beyond) {
    refused_ = Error{fmt::format("at byte {}: {}", record.offset, why.what), why.remedy};
    return;
  }
  ++out_.chunks_left_out;
  out_.chunks.push_back(index_of(chunk, record));
  ++out_.statistics.chunks;
}

void Scanner::take_chunk(const RecordView& record) {
  const auto chunk = decode_chunk(record.content);
  if (!chunk) {
    ++out_.chunks_lost;
    suspect_ = Suspect::record;
    return fault(record.offset, "a chunk that is cut off");
  }
  const auto content = opener_.open(*chunk);
  if (!content) {
    if (opener_.exhausted()) return refuse_or_leave_out(*chunk, record, content.error());
    ++out_.chunks_lost;
    // The chunk of a recording that was cut off reaches into the recording that was joined to it.
    suspect_ = Suspect::joined_recording;
    return fault(record.offset, "{}", content.error().what);
  }
  in_chunk_ = true;
  chunk_channels_.clear();
  RecordList records(*content);
  while (const auto inner = records.next()) {
    if (!take_inner(*inner, record.offset))
      fault(record.offset, "the chunk has a record of kind {:#04x} at its byte {}", inner->opcode, inner->offset);
  }
  if (!records.ok()) fault(record.offset, "the chunk has no whole record at its byte {}", records.offset());
  in_chunk_ = false;
  suspect_ = Suspect::nothing;  // the length of the chunk is right, whatever is in it
  ChunkIndex index = index_of(*chunk, record);
  for (const std::uint16_t channel : chunk_channels_) index.message_index_offsets[channel] = 0;
  out_.chunks.push_back(std::move(index));
  ++out_.statistics.chunks;
}

void Scanner::take(const RecordView& record) {
  // Nothing but its length tells where such a record ends: cut off, it reaches into the recording that was joined to
  // it.
  if (!record.is(Opcode::attachment) && !record.is(Opcode::message)) suspect_ = Suspect::joined_recording;
  if (take_inner(record, record.offset)) return;
  if (record.is(Opcode::chunk)) return take_chunk(record);
  if (record.is(Opcode::header)) {
    auto header = decode_header(record.content);
    if (header && !has_header_) {
      if (!joined_) out_.header = *std::move(header);
    } else {
      fault(record.offset, "a header that is wrong or not the first");
    }
    has_header_ = true;
  } else if (record.is(Opcode::attachment)) {
    bool crc_ok = false;
    const auto attachment = decode_attachment(record.content, crc_ok);
    if (!attachment) suspect_ = Suspect::record;
    if (!attachment || !crc_ok) return fault(record.offset, "an attachment that is cut off, or has a wrong CRC");
    ++out_.statistics.attachments;
    visitor_.on_attachment(*attachment, record);
  } else if (record.is(Opcode::metadata)) {
    const auto metadata = decode_metadata(record.content);
    if (!metadata) suspect_ = Suspect::record;
    if (!metadata) return fault(record.offset, "metadata that are cut off");
    ++out_.statistics.metadata;
    visitor_.on_metadata(*metadata, record);
  }
}

bool Scanner::go_on_at(const std::optional<FoundRecord>& found) {
  if (!found) return false;
  if (found->begins_recording) {
    begin_recording(found->offset);
  } else {
    take_catalogue_of_summary();
    stream_.seek(found->offset);
  }
  out_.whole_until = stream_.offset();
  return true;
}

void Scanner::look_into_suspect(const RecordView& record) {
  const Suspect suspect = std::exchange(suspect_, Suspect::nothing);
  if (suspect == Suspect::nothing) return;
  // Records that overlap, made on purpose, would take a time that grows with the square of the size.
  constexpr std::uint64_t kMostPasses = 4;
  suspect_bytes_ += record.end() - record.offset;
  if (suspect_bytes_ / kMostPasses > source_.size()) return;
  const std::uint64_t from = record.offset + 1;
  const std::uint64_t to = record.end();
  go_on_at(suspect == Suspect::record ? finder_.next(from, to) : finder_.next_recording(from, to));
}

void Scanner::take_catalogue_of_summary() {
  if (std::exchange(summary_taken_, true)) return;
  auto summary = read_summary(source_, limits_);
  if (!summary) return;
  for (auto& [id, schema] : summary->catalogue.schemas) {
    if (ids_.add(schema, out_.catalogue).empty()) visitor_.on_schema(schema);
  }
  for (auto& [id, channel] : summary->catalogue.channels) {
    if (ids_.add(channel, out_.catalogue).empty()) visitor_.on_channel(channel);
  }
}

void Scanner::begin_recording(std::uint64_t offset) {
  fault(offset, "another recording begins here: files were joined");
  ++out_.recordings;
  out_.chunks_have_all = false;  // their channels may have other ids than in the catalogue
  ids_.begin_recording();
  has_header_ = false;
  joined_ = true;
  summary_taken_ = true;
  stream_.seek(offset + kMagic.size());
}

std::optional<std::uint64_t> Scanner::end_of_summary(const RecordView& data_end) {
  bool footer = data_end.is(Opcode::footer);
  while (!footer) {
    const auto record = stream_.next();
    if (!record || !*record) return std::nullopt;
    footer = (*record)->is(Opcode::footer);
  }
  std::array<std::byte, kMagic.size()> magic;
  const std::uint64_t at = stream_.offset();
  if (source_.size() - at < magic.size() || !source_.read(at, magic) ||
      !std::ranges::equal(magic, std::as_bytes(std::span(kMagic))))
    return std::nullopt;
  return at + magic.size();
}

bool Scanner::end_recording(const RecordView& data_end) {
  const std::uint64_t offset = data_end.offset;
  const auto end = end_of_summary(data_end);
  if (end != source_.size() && go_on_at(finder_.next_recording(end.value_or(stream_.offset()), source_.size())))
    return false;
  look_at_end(offset);
  return true;
}

bool Scanner::run_records() {
  for (;;) {
    const auto record = stream_.next();
    if (!record) {
      // "at byte N: ..." is the stream's way to say it to those who have nothing else.
      const std::string& what = record.error().what;
      const std::size_t colon = what.starts_with("at byte") ? what.find(": ") : std::string::npos;
      fault(stream_.offset(), "{}", colon == std::string::npos ? what : what.substr(colon + 2));
      return false;
    }
    if (!*record) {
      fault(stream_.offset(), "the file ends without an end of its data");
      return true;
    }
    if ((*record)->is(Opcode::data_end) || (*record)->is(Opcode::footer)) {
      if (!decode_data_end((*record)->content)) fault((*record)->offset, "an end of data that is cut off");
      out_.whole_until = (*record)->end();
      if (end_recording(**record)) return true;
      continue;
    }
    take(**record);
    if (refused_) return true;
    if (limits_.progress != nullptr) (*limits_.progress)((*record)->end(), source_.size());
    if (!has_header_) {
      fault((*record)->offset, "the first record is no header");
      has_header_ = true;
    }
    out_.whole_until = (*record)->end();
    look_into_suspect(**record);
  }
}

void Scanner::look_at_end(std::uint64_t offset) {
  std::array<std::byte, kMagic.size()> end;
  const bool magic = source_.read(source_.size() - end.size(), end).has_value() &&
                     std::ranges::equal(end, std::as_bytes(std::span(kMagic)));
  out_.ended = magic;
  if (!magic) fault(offset, "the file is cut off in its summary");
}

Result<ScanReport> Scanner::run() {
  std::array<std::byte, kMagic.size()> begin;
  if (source_.size() < begin.size() || !source_.read(0, begin) ||
      !std::ranges::equal(begin, std::as_bytes(std::span(kMagic))))
    return fail("at byte 0: this is no MCAP file of version 0: its first bytes are others",
                "name a file that cellmirror record or another MCAP writer has made");
  out_.whole_until = begin.size();
  // Ends: each round begins behind the one before.
  while (!run_records()) {
    // At the byte itself: it may be the magic of a recording that was joined to one that was cut off.
    if (!go_on_at(finder_.next(stream_.offset(), source_.size()))) break;
  }
  if (refused_) return std::unexpected(*refused_);
  out_.statistics.schemas = static_cast<std::uint16_t>(out_.catalogue.schemas.size());
  out_.statistics.channels = static_cast<std::uint32_t>(out_.catalogue.channels.size());
  return std::move(out_);
}

}  // namespace

Result<ScanReport> scan(const Source& source, const Limits& limits, Visitor& visitor) {
  return Scanner(source, limits, visitor).run();
}

}  // namespace cellmirror::mcap
