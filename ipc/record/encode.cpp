#include "ipc/record/encode.hpp"

namespace cellmirror::mcap {

Encoder& Encoder::texts(const Texts& texts) {
  std::size_t size = 0;
  for (const auto& [key, value] : texts) size += 8 + key.size() + value.size();
  number(static_cast<std::uint32_t>(size));
  for (const auto& [key, value] : texts) text(key).text(value);
  return *this;
}

Encoder& Encoder::begin(Opcode opcode) {
  number(static_cast<std::uint8_t>(opcode)).number(std::uint64_t{0});
  begun_ = out_.size();
  return *this;
}

void Encoder::end() {
  const std::uint64_t length = out_.size() - begun_;
  for (std::size_t i = 0; i < sizeof length; ++i)
    out_[begun_ - sizeof length + i] = static_cast<std::byte>((length >> (8 * i)) & 0xFFU);
}

void append_magic(Bytes& out) { Encoder(out).bytes(std::as_bytes(std::span(kMagic))); }

void append(const Header& record, Bytes& out) {
  Encoder to(out);
  to.begin(Opcode::header).text(record.profile).text(record.library).end();
}

void append(const Footer& record, Bytes& out) {
  Encoder to(out);
  to.begin(Opcode::footer)
      .number(record.summary_start)
      .number(record.summary_offset_start)
      .number(record.summary_crc)
      .end();
}

void append(const Schema& record, Bytes& out) {
  Encoder to(out);
  to.begin(Opcode::schema).number(record.id).text(record.name).text(record.encoding).text(record.data).end();
}

void append(const Channel& record, Bytes& out) {
  Encoder to(out);
  to.begin(Opcode::channel)
      .number(record.id)
      .number(record.schema)
      .text(record.topic)
      .text(record.encoding)
      .texts(record.metadata)
      .end();
}

// The record that there are millions of: its head is put together before it is appended.
void append(const Message& record, Bytes& out) {
  std::array<std::byte, kMessageHead> head;
  std::size_t at = 0;
  const auto put = [&](auto value) {
    for (std::size_t i = 0; i < sizeof value; ++i) head[at++] = static_cast<std::byte>((value >> (8 * i)) & 0xFFU);
  };
  put(static_cast<std::uint8_t>(Opcode::message));
  put(std::uint64_t{kMessageHead - kRecordHead + record.data.size()});
  put(record.channel);
  put(record.sequence);
  put(record.log_time);
  put(record.publish_time);
  out.insert(out.end(), head.begin(), head.end());
  out.insert(out.end(), record.data.begin(), record.data.end());
}

void append(const Chunk& record, Bytes& out) {
  Encoder to(out);
  to.begin(Opcode::chunk)
      .number(record.start_time)
      .number(record.end_time)
      .number(record.uncompressed_size)
      .number(record.uncompressed_crc)
      .text(record.compression)
      .number(std::uint64_t{record.records.size()})
      .bytes(record.records)
      .end();
}

void append(const MessageIndex& record, Bytes& out) {
  Encoder to(out);
  to.begin(Opcode::message_index).number(record.channel).number(static_cast<std::uint32_t>(record.entries.size() * 16));
  for (const auto& [time, offset] : record.entries) to.number(time).number(offset);
  to.end();
}

void append(const ChunkIndex& record, Bytes& out) {
  Encoder to(out);
  to.begin(Opcode::chunk_index)
      .number(record.start_time)
      .number(record.end_time)
      .number(record.offset)
      .number(record.length)
      .number(static_cast<std::uint32_t>(record.message_index_offsets.size() * 10));
  for (const auto& [channel, offset] : record.message_index_offsets) to.number(channel).number(offset);
  to.number(record.message_index_length)
      .text(record.compression)
      .number(record.compressed_size)
      .number(record.uncompressed_size)
      .end();
}

void append(const Attachment& record, Bytes& out) {
  Encoder to(out);
  const std::size_t content = out.size() + kRecordHead;
  to.begin(Opcode::attachment)
      .number(record.log_time)
      .number(record.create_time)
      .text(record.name)
      .text(record.media_type)
      .number(std::uint64_t{record.data.size()})
      .bytes(record.data);
  to.number(crc32(View(out).subspan(content))).end();
}

void append(const AttachmentIndex& record, Bytes& out) {
  Encoder to(out);
  to.begin(Opcode::attachment_index)
      .number(record.offset)
      .number(record.length)
      .number(record.log_time)
      .number(record.create_time)
      .number(record.data_size)
      .text(record.name)
      .text(record.media_type)
      .end();
}

void append(const Statistics& record, Bytes& out) {
  Encoder to(out);
  to.begin(Opcode::statistics)
      .number(record.messages)
      .number(record.schemas)
      .number(record.channels)
      .number(record.attachments)
      .number(record.metadata)
      .number(record.chunks)
      .number(record.start_time)
      .number(record.end_time)
      .number(static_cast<std::uint32_t>(record.channel_messages.size() * 10));
  for (const auto& [channel, messages] : record.channel_messages) to.number(channel).number(messages);
  to.end();
}

void append(const Metadata& record, Bytes& out) {
  Encoder to(out);
  to.begin(Opcode::metadata).text(record.name).texts(record.values).end();
}

void append(const MetadataIndex& record, Bytes& out) {
  Encoder to(out);
  to.begin(Opcode::metadata_index).number(record.offset).number(record.length).text(record.name).end();
}

void append(const SummaryOffset& record, Bytes& out) {
  Encoder to(out);
  to.begin(Opcode::summary_offset).number(record.opcode).number(record.start).number(record.length).end();
}

void append_data_end(std::uint32_t data_section_crc, Bytes& out) {
  Encoder to(out);
  to.begin(Opcode::data_end).number(data_section_crc).end();
}

}  // namespace cellmirror::mcap
