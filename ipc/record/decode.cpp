#include "ipc/record/decode.hpp"

namespace cellmirror::mcap {

namespace {

template <class Record>
std::optional<Record> whole(const Decoder& from, Record record) {
  if (!from.ok()) return std::nullopt;
  return record;
}

}  // namespace

View Decoder::take(std::uint64_t size) {
  if (!ok_ || size > in_.size() - position_) {
    ok_ = false;
    return {};
  }
  const View out = in_.subspan(position_, static_cast<std::size_t>(size));
  position_ += out.size();
  return out;
}

std::string Decoder::text() {
  const View from = take(number<std::uint32_t>());
  return {reinterpret_cast<const char*>(from.data()), from.size()};
}

Texts Decoder::texts() {
  Texts out;
  Decoder inner = part();
  while (ok_ && inner.ok() && !inner.at_end()) {
    std::string key = inner.text();
    std::string value = inner.text();
    if (inner.ok()) out.insert_or_assign(std::move(key), std::move(value));
  }
  ok_ = ok_ && inner.ok();
  return out;
}

std::map<std::uint16_t, std::uint64_t> Decoder::numbers() {
  std::map<std::uint16_t, std::uint64_t> out;
  Decoder inner = part();
  while (ok_ && inner.ok() && !inner.at_end()) {
    const auto key = inner.number<std::uint16_t>();
    const auto value = inner.number<std::uint64_t>();
    if (inner.ok()) out.insert_or_assign(key, value);
  }
  ok_ = ok_ && inner.ok();
  return out;
}

std::optional<Header> decode_header(View content) {
  Decoder from(content);
  Header out;
  out.profile = from.text();
  out.library = from.text();
  return whole(from, std::move(out));
}

std::optional<Footer> decode_footer(View content) {
  Decoder from(content);
  Footer out;
  out.summary_start = from.number<std::uint64_t>();
  out.summary_offset_start = from.number<std::uint64_t>();
  out.summary_crc = from.number<std::uint32_t>();
  return whole(from, out);
}

std::optional<Schema> decode_schema(View content) {
  Decoder from(content);
  Schema out;
  out.id = from.number<std::uint16_t>();
  out.name = from.text();
  out.encoding = from.text();
  out.data = from.text();
  if (out.id == 0) from.refuse();
  return whole(from, std::move(out));
}

std::optional<Channel> decode_channel(View content) {
  Decoder from(content);
  Channel out;
  out.id = from.number<std::uint16_t>();
  out.schema = from.number<std::uint16_t>();
  out.topic = from.text();
  out.encoding = from.text();
  out.metadata = from.texts();
  return whole(from, std::move(out));
}

std::optional<Message> decode_message(View content) {
  Decoder from(content);
  Message out;
  out.channel = from.number<std::uint16_t>();
  out.sequence = from.number<std::uint32_t>();
  out.log_time = from.number<std::uint64_t>();
  out.publish_time = from.number<std::uint64_t>();
  if (from.ok()) out.data = content.subspan(from.position());
  return whole(from, out);
}

std::optional<Chunk> decode_chunk(View content) {
  Decoder from(content);
  Chunk out;
  out.start_time = from.number<std::uint64_t>();
  out.end_time = from.number<std::uint64_t>();
  out.uncompressed_size = from.number<std::uint64_t>();
  out.uncompressed_crc = from.number<std::uint32_t>();
  out.compression = from.text();
  out.records = from.bytes(from.number<std::uint64_t>());
  return whole(from, std::move(out));
}

std::optional<MessageIndex> decode_message_index(View content) {
  Decoder from(content);
  MessageIndex out;
  out.channel = from.number<std::uint16_t>();
  Decoder entries = from.part();
  while (entries.ok() && !entries.at_end()) {
    const auto time = entries.number<std::uint64_t>();
    const auto offset = entries.number<std::uint64_t>();
    if (entries.ok()) out.entries.emplace_back(time, offset);
  }
  if (!entries.ok()) from.refuse();
  return whole(from, std::move(out));
}

std::optional<ChunkIndex> decode_chunk_index(View content) {
  Decoder from(content);
  ChunkIndex out;
  out.start_time = from.number<std::uint64_t>();
  out.end_time = from.number<std::uint64_t>();
  out.offset = from.number<std::uint64_t>();
  out.length = from.number<std::uint64_t>();
  out.message_index_offsets = from.numbers();
  out.message_index_length = from.number<std::uint64_t>();
  out.compression = from.text();
  out.compressed_size = from.number<std::uint64_t>();
  out.uncompressed_size = from.number<std::uint64_t>();
  return whole(from, std::move(out));
}

std::optional<Attachment> decode_attachment(View content, bool& crc_ok) {
  Decoder from(content);
  Attachment out;
  out.log_time = from.number<std::uint64_t>();
  out.create_time = from.number<std::uint64_t>();
  out.name = from.text();
  out.media_type = from.text();
  out.data = from.bytes(from.number<std::uint64_t>());
  const std::size_t covered = from.position();
  const auto crc = from.number<std::uint32_t>();
  crc_ok = from.ok() && (crc == 0 || crc == crc32(content.first(covered)));
  return whole(from, std::move(out));
}

std::optional<AttachmentIndex> decode_attachment_index(View content) {
  Decoder from(content);
  AttachmentIndex out;
  out.offset = from.number<std::uint64_t>();
  out.length = from.number<std::uint64_t>();
  out.log_time = from.number<std::uint64_t>();
  out.create_time = from.number<std::uint64_t>();
  out.data_size = from.number<std::uint64_t>();
  out.name = from.text();
  out.media_type = from.text();
  return whole(from, std::move(out));
}

std::optional<Statistics> decode_statistics(View content) {
  Decoder from(content);
  Statistics out;
  out.messages = from.number<std::uint64_t>();
  out.schemas = from.number<std::uint16_t>();
  out.channels = from.number<std::uint32_t>();
  out.attachments = from.number<std::uint32_t>();
  out.metadata = from.number<std::uint32_t>();
  out.chunks = from.number<std::uint32_t>();
  out.start_time = from.number<std::uint64_t>();
  out.end_time = from.number<std::uint64_t>();
  out.channel_messages = from.numbers();
  return whole(from, std::move(out));
}

std::optional<Metadata> decode_metadata(View content) {
  Decoder from(content);
  Metadata out;
  out.name = from.text();
  out.values = from.texts();
  return whole(from, std::move(out));
}

std::optional<MetadataIndex> decode_metadata_index(View content) {
  Decoder from(content);
  MetadataIndex out;
  out.offset = from.number<std::uint64_t>();
  out.length = from.number<std::uint64_t>();
  out.name = from.text();
  return whole(from, std::move(out));
}

std::optional<SummaryOffset> decode_summary_offset(View content) {
  Decoder from(content);
  SummaryOffset out;
  out.opcode = from.number<std::uint8_t>();
  out.start = from.number<std::uint64_t>();
  out.length = from.number<std::uint64_t>();
  return whole(from, out);
}

std::optional<std::uint32_t> decode_data_end(View content) {
  Decoder from(content);
  return whole(from, from.number<std::uint32_t>());
}

}  // namespace cellmirror::mcap
