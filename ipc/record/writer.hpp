// Writes a recording as an MCAP file. Whatever ends the process, the file is readable up to the last chunk that was
// written: schemas and channels are written before the first chunk that uses them, each chunk and its indexes by one
// call, and finish() only adds the summary. One thread; not for the tick.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ipc/record/byte_stream.hpp"
#include "ipc/record/compression.hpp"
#include "ipc/record/layout.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::mcap {

struct WriterOptions {
  std::string profile = "ros2";
  std::string library = "cellmirror";
  Compression compression = Compression::zstd;
  std::size_t chunk_bytes = std::size_t{1} << 20;  // of uncompressed records, from which a chunk is written
};

// After a failed call the file is as before it. What was in the chunk then is lost: lost() counts it by channel.
class Writer {
 public:
  // `out` outlives the writer, and has nothing in it.
  Writer(Sink& out, WriterOptions options);

  // First.
  Result<void> begin();
  // Written at once. An id that is used already with other content is a broken contract.
  Result<void> put(const Schema& schema);
  Result<void> put(const Channel& channel);  // its schema was put, or is 0
  // The channel was put. Fails where a full chunk cannot be written; the message itself is in the next one.
  Result<void> put(const Message& message);
  // Written at once, behind what is in the chunk.
  Result<void> put(const Attachment& attachment);
  Result<void> put(const Metadata& metadata);
  // Writes the chunk that has begun, if it has.
  Result<void> flush();
  // flush(), then the summary and the end. Nothing may be put after it.
  Result<void> finish();

  [[nodiscard]] const Statistics& statistics() const { return statistics_; }  // of what is written
  [[nodiscard]] std::uint64_t bytes() const { return position_; }             // written
  [[nodiscard]] std::size_t waiting_bytes() const { return chunk_.size(); }   // in the chunk that has begun
  [[nodiscard]] bool knows_schema(std::uint16_t id) const { return schemas_.contains(id); }
  // Messages by channel id of chunks that could not be written.
  [[nodiscard]] const std::map<std::uint16_t, std::uint64_t>& lost() const { return lost_; }

 private:
  Result<void> write(View bytes);
  void append_message_indexes(ChunkIndex& index);
  void begin_chunk();
  [[nodiscard]] Bytes summary() const;

  Sink& out_;
  WriterOptions options_;
  Compressor compressor_;
  std::uint64_t position_ = 0;
  Bytes scratch_;

  Bytes chunk_;                         // records that are not written yet
  std::vector<MessageIndex> indexes_;   // by channel id
  std::vector<std::uint16_t> indexed_;  // channels in the chunk
  Statistics in_chunk_;                 // of the chunk's messages; start_time and end_time of them

  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, Channel> channels_;
  std::vector<ChunkIndex> chunks_;
  std::vector<AttachmentIndex> attachments_;
  std::vector<MetadataIndex> metadata_;
  Statistics statistics_;
  std::map<std::uint16_t, std::uint64_t> lost_;
};

}  // namespace cellmirror::mcap
