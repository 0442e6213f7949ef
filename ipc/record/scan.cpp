#include "ipc/record/scan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "ipc/record/decode.hpp"
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
      : source_(source), limits_(limits), visitor_(visitor), opener_(limits, source.size()) {}

  Result<ScanReport> run();

 private:
  // Up to the end of the data or what cannot be read; true where it came to the end.
  bool run_from(std::uint64_t offset);
  // The first chunk behind `offset` that the summary knows.
  std::optional<std::uint64_t> chunk_behind(std::uint64_t offset);
  void take(const RecordView& record);
  void take_chunk(const RecordView& record);
  // Handles a chunk beyond the limit of decompressed bytes.
  void refuse_or_leave_out(const Chunk& chunk, const RecordView& record, const Error& why);
  void take_message(const Message& message, std::uint64_t offset);
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
  std::optional<std::vector<std::uint64_t>> known_chunks_;
  std::uint64_t last_time_ = 0;
  bool in_chunk_ = false;
  std::set<std::uint16_t> chunk_channels_;
  bool has_header_ = false;
  std::optional<Error> refused_;  // set: the scan ends with this error
};

void Scanner::take_message(const Message& message, std::uint64_t offset) {
  const auto channel = out_.catalogue.channels.find(message.channel);
  if (channel == out_.catalogue.channels.end())
    return fault(offset, "a message of the channel {}, which is not described", message.channel);
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
    const auto schema = decode_schema(record.content);
    const std::string wrong = schema ? out_.catalogue.add(*schema) : "a schema that is cut off, or has the id 0";
    if (!wrong.empty()) {
      fault(offset, "{}", wrong);
    } else {
      visitor_.on_schema(*schema);
    }
    return true;
  }
  if (record.is(Opcode::channel)) {
    const auto channel = decode_channel(record.content);
    const std::string wrong = channel ? out_.catalogue.add(*channel) : "a channel that is cut off";
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
    return fault(record.offset, "a chunk that is cut off");
  }
  const auto content = opener_.open(*chunk);
  if (!content) {
    if (opener_.exhausted()) return refuse_or_leave_out(*chunk, record, content.error());
    ++out_.chunks_lost;
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
  ChunkIndex index = index_of(*chunk, record);
  for (const std::uint16_t channel : chunk_channels_) index.message_index_offsets[channel] = 0;
  out_.chunks.push_back(std::move(index));
  ++out_.statistics.chunks;
}

void Scanner::take(const RecordView& record) {
  if (take_inner(record, record.offset)) return;
  if (record.is(Opcode::chunk)) return take_chunk(record);
  if (record.is(Opcode::header)) {
    auto header = decode_header(record.content);
    if (header && !has_header_) {
      out_.header = *std::move(header);
    } else {
      fault(record.offset, "a header that is wrong or not the first");
    }
    has_header_ = true;
  } else if (record.is(Opcode::attachment)) {
    bool crc_ok = false;
    const auto attachment = decode_attachment(record.content, crc_ok);
    if (!attachment || !crc_ok) return fault(record.offset, "an attachment that is cut off, or has a wrong CRC");
    ++out_.statistics.attachments;
    visitor_.on_attachment(*attachment, record);
  } else if (record.is(Opcode::metadata)) {
    const auto metadata = decode_metadata(record.content);
    if (!metadata) return fault(record.offset, "metadata that are cut off");
    ++out_.statistics.metadata;
    visitor_.on_metadata(*metadata, record);
  }
}

std::optional<std::uint64_t> Scanner::chunk_behind(std::uint64_t offset) {
  if (!known_chunks_) {
    known_chunks_.emplace();
    if (const auto summary = read_summary(source_, limits_)) {
      for (const ChunkIndex& chunk : summary->chunks) known_chunks_->push_back(chunk.offset);
      std::ranges::sort(*known_chunks_);
    }
  }
  const auto found = std::ranges::upper_bound(*known_chunks_, offset);
  if (found == known_chunks_->end() || *found >= source_.size()) return std::nullopt;
  return *found;
}

bool Scanner::run_from(std::uint64_t offset) {
  RecordStream stream(source_, offset, source_.size(), limits_);
  for (;;) {
    const auto record = stream.next();
    if (!record) {
      // "at byte N: ..." is the stream's way to say it to those who have nothing else.
      const std::string& what = record.error().what;
      const std::size_t colon = what.starts_with("at byte") ? what.find(": ") : std::string::npos;
      fault(stream.offset(), "{}", colon == std::string::npos ? what : what.substr(colon + 2));
      return false;
    }
    if (!*record) {
      fault(stream.offset(), "the file ends without an end of its data");
      return true;
    }
    if ((*record)->is(Opcode::data_end) || (*record)->is(Opcode::footer)) {
      if (!decode_data_end((*record)->content)) fault((*record)->offset, "an end of data that is cut off");
      out_.whole_until = (*record)->end();
      look_at_end((*record)->offset);
      return true;
    }
    take(**record);
    if (refused_) return true;
    if (limits_.progress != nullptr) (*limits_.progress)((*record)->end(), source_.size());
    if (!has_header_) {
      fault((*record)->offset, "the first record is no header");
      has_header_ = true;
    }
    out_.whole_until = (*record)->end();
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
  std::uint64_t from = begin.size();
  out_.whole_until = from;
  // Ends: each round begins behind the one before.
  while (!run_from(from)) {
    const auto next = chunk_behind(out_.whole_until);
    if (!next) break;
    from = *next;
    out_.whole_until = from;
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
