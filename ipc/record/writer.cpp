#include "ipc/record/writer.hpp"

#include <algorithm>
#include <utility>

#include "ipc/record/encode.hpp"
#include "rt_core/base/contract.hpp"

namespace cellmirror::mcap {

namespace {

// The chunk's content begins so far behind the start of its record, with a compression's word of so many letters.
constexpr std::size_t kLargeScratch = std::size_t{4} << 20;
constexpr std::size_t kChunkHead = kRecordHead + 8 + 8 + 8 + 4 + 4 + 8;

}  // namespace

Writer::Writer(Sink& out, WriterOptions options)
    : out_(out), options_(std::move(options)), compressor_(options_.compression) {
  chunk_.reserve(options_.chunk_bytes + options_.chunk_bytes / 4);
}

Result<void> Writer::write(View bytes) {
  auto written = out_.write(std::span(&bytes, 1));
  if (written) position_ += bytes.size();
  return written;
}

Result<void> Writer::begin() {
  scratch_.clear();
  append_magic(scratch_);
  append(Header{options_.profile, options_.library}, scratch_);
  return write(scratch_);
}

Result<void> Writer::put(const Schema& schema) {
  CELLMIRROR_EXPECTS(schema.id != 0);
  if (const auto known = schemas_.find(schema.id); known != schemas_.end()) {
    CELLMIRROR_EXPECTS(known->second == schema);
    return {};
  }
  scratch_.clear();
  append(schema, scratch_);
  if (auto written = write(scratch_); !written) return written;
  schemas_.emplace(schema.id, schema);
  ++statistics_.schemas;
  return {};
}

Result<void> Writer::put(const Channel& channel) {
  CELLMIRROR_EXPECTS(channel.schema == 0 || schemas_.contains(channel.schema));
  if (const auto known = channels_.find(channel.id); known != channels_.end()) {
    CELLMIRROR_EXPECTS(known->second == channel);
    return {};
  }
  scratch_.clear();
  append(channel, scratch_);
  if (auto written = write(scratch_); !written) return written;
  channels_.emplace(channel.id, channel);
  if (indexes_.size() <= channel.id) indexes_.resize(std::size_t{channel.id} + 1);
  indexes_[channel.id].channel = channel.id;
  ++statistics_.channels;
  return {};
}

Result<void> Writer::put(const Message& message) {
  CELLMIRROR_EXPECTS(channels_.contains(message.channel));
  Result<void> outcome;
  if (chunk_.size() + kMessageHead + message.data.size() > options_.chunk_bytes) outcome = flush();
  MessageIndex& index = indexes_[message.channel];
  if (index.entries.empty()) indexed_.push_back(message.channel);
  index.entries.emplace_back(message.log_time, chunk_.size());
  append(message, chunk_);
  in_chunk_.start_time = in_chunk_.messages == 0 ? message.log_time : std::min(in_chunk_.start_time, message.log_time);
  in_chunk_.end_time = std::max(in_chunk_.end_time, message.log_time);
  ++in_chunk_.messages;
  return outcome;
}

void Writer::append_message_indexes(ChunkIndex& index) {
  const std::size_t before = scratch_.size();
  std::ranges::sort(indexed_);
  for (const std::uint16_t channel : indexed_) {
    index.message_index_offsets.emplace(channel, index.offset + index.length + scratch_.size() - before);
    append(indexes_[channel], scratch_);
  }
  index.message_index_length = scratch_.size() - before;
}

void Writer::begin_chunk() {
  chunk_.clear();
  for (const std::uint16_t channel : indexed_) indexes_[channel].entries.clear();
  indexed_.clear();
  in_chunk_ = {};
}

Result<void> Writer::flush() {
  if (in_chunk_.messages == 0) return {};
  const auto compressed = compressor_.compress(chunk_);
  Result<void> written;
  if (!compressed) {
    written = std::unexpected(compressed.error());
  } else {
    ChunkIndex index;
    index.start_time = in_chunk_.start_time;
    index.end_time = in_chunk_.end_time;
    index.offset = position_;
    index.compression = word(options_.compression);
    index.compressed_size = compressed->size();
    index.uncompressed_size = chunk_.size();
    index.length = kChunkHead + index.compression.size() + compressed->size();
    scratch_.clear();
    // The record's head without its content, which would have to be copied.
    Encoder(scratch_)
        .number(static_cast<std::uint8_t>(Opcode::chunk))
        .number(index.length - kRecordHead)
        .number(index.start_time)
        .number(index.end_time)
        .number(index.uncompressed_size)
        .number(crc32(chunk_))
        .text(index.compression)
        .number(index.compressed_size);
    const std::size_t head = scratch_.size();
    append_message_indexes(index);
    const std::array<View, 3> pieces = {View(scratch_).first(head), *compressed, View(scratch_).subspan(head)};
    written = out_.write(pieces);
    if (written) {
      position_ += index.length + index.message_index_length;
      chunks_.push_back(std::move(index));
    }
  }
  if (written) {
    statistics_.start_time =
        statistics_.messages == 0 ? in_chunk_.start_time : std::min(statistics_.start_time, in_chunk_.start_time);
    statistics_.end_time = std::max(statistics_.end_time, in_chunk_.end_time);
    statistics_.messages += in_chunk_.messages;
    ++statistics_.chunks;
  }
  for (const std::uint16_t channel : indexed_)
    (written ? statistics_.channel_messages : lost_)[channel] += indexes_[channel].entries.size();
  begin_chunk();
  return written;
}

Result<void> Writer::put(const Attachment& attachment) {
  scratch_.clear();
  append(attachment, scratch_);
  const std::uint64_t offset = position_;
  if (auto written = write(scratch_); !written) return written;
  attachments_.push_back({offset, scratch_.size(), attachment.log_time, attachment.create_time, attachment.data.size(),
                          attachment.name, attachment.media_type});
  ++statistics_.attachments;
  if (scratch_.capacity() > kLargeScratch) Bytes().swap(scratch_);
  return {};
}

Result<void> Writer::put(const Metadata& metadata) {
  scratch_.clear();
  append(metadata, scratch_);
  const std::uint64_t offset = position_;
  if (auto written = write(scratch_); !written) return written;
  metadata_.push_back({offset, scratch_.size(), metadata.name});
  ++statistics_.metadata;
  return {};
}

// The summary in groups of one kind, where the groups are, and the footer; it begins at position_.
Bytes Writer::summary() const {
  Bytes out;
  Bytes offsets;
  const auto group = [&](Opcode opcode, std::size_t begun) {
    if (out.size() == begun) return;
    append(SummaryOffset{static_cast<std::uint8_t>(opcode), position_ + begun, out.size() - begun}, offsets);
  };
  std::size_t begun = out.size();
  for (const auto& [id, schema] : schemas_) append(schema, out);
  group(Opcode::schema, begun);
  begun = out.size();
  for (const auto& [id, channel] : channels_) append(channel, out);
  group(Opcode::channel, begun);
  begun = out.size();
  append(statistics_, out);
  group(Opcode::statistics, begun);
  begun = out.size();
  for (const ChunkIndex& chunk : chunks_) append(chunk, out);
  group(Opcode::chunk_index, begun);
  begun = out.size();
  for (const AttachmentIndex& attachment : attachments_) append(attachment, out);
  group(Opcode::attachment_index, begun);
  begun = out.size();
  for (const MetadataIndex& metadata : metadata_) append(metadata, out);
  group(Opcode::metadata_index, begun);
  Footer footer{position_, position_ + out.size(), 0};
  out.insert(out.end(), offsets.begin(), offsets.end());
  const std::size_t before = out.size();
  append(footer, out);
  // The CRC covers the summary and the footer up to the CRC itself.
  footer.summary_crc = crc32(View(out).first(out.size() - sizeof footer.summary_crc));
  out.resize(before);
  append(footer, out);
  append_magic(out);
  return out;
}

Result<void> Writer::finish() {
  // What is written so far gets its summary even if the last chunk finds no room.
  const Result<void> flushed = flush();
  scratch_.clear();
  append_data_end(0, scratch_);
  if (auto written = write(scratch_); !written) return written;
  if (auto written = write(summary()); !written) return written;
  return flushed;
}

}  // namespace cellmirror::mcap
