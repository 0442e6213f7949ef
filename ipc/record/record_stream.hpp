// The records of a source one after the other, their lengths checked against what there is. Nothing is trusted. One
// thread.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>

#include "ipc/record/byte_stream.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::mcap {

// Progress of reading a file, in bytes. Called often.
using ReadProgress = std::function<void(std::uint64_t done, std::uint64_t total)>;

// What a reader accepts. More than a recording of ours ever has.
struct Limits {
  std::uint64_t record_bytes = std::uint64_t{1} << 30;   // one record, e.g. an attachment
  std::uint64_t chunk_bytes = std::uint64_t{256} << 20;  // decompressed
  std::uint64_t summary_bytes = std::uint64_t{256} << 20;
  // Limit for the decompressed size of all compressed chunks in one pass: the larger of decompressed_bytes and
  // decompressed_ratio times the size of the file. 200 MB of zeros compress to 6 kB.
  std::uint64_t decompressed_bytes = std::uint64_t{1} << 30;
  std::uint64_t decompressed_ratio = 200;
  // A scan leaves out and counts chunks beyond this limit; if false, it fails at the first of them.
  bool leave_out_beyond = false;
  const ReadProgress* progress = nullptr;  // outlives the reader

  [[nodiscard]] std::uint64_t most_decompressed(std::uint64_t file_bytes) const {
    constexpr auto kAny = std::numeric_limits<std::uint64_t>::max();
    const bool overflows = decompressed_ratio > 0 && file_bytes > kAny / decompressed_ratio;
    return overflows ? kAny : std::max(decompressed_bytes, decompressed_ratio * file_bytes);
  }
};

struct RecordView {
  std::uint8_t opcode = 0;
  std::uint64_t offset = 0;  // of the opcode
  View content = {};         // valid until the next call

  [[nodiscard]] bool is(Opcode wanted) const { return opcode == static_cast<std::uint8_t>(wanted); }
  [[nodiscard]] std::uint64_t end() const { return offset + kRecordHead + content.size(); }
};

class RecordStream {
 public:
  // From `from` up to `end`, at most the end of the source; all outlive the stream.
  RecordStream(const Source& source, std::uint64_t from, std::uint64_t end, const Limits& limits);

  // None at the end. An error names the byte; no further record can be found then.
  Result<std::optional<RecordView>> next();
  // Where the next record begins, or the one that cannot be read.
  [[nodiscard]] std::uint64_t offset() const { return offset_; }
  // The next record begins at `offset`.
  void seek(std::uint64_t offset) { offset_ = offset; }

 private:
  // `size` bytes at offset_; they are there.
  Result<View> bytes(std::uint64_t size);

  const Source& source_;
  std::uint64_t offset_;
  std::uint64_t end_;
  Limits limits_;
  Bytes window_;
  std::uint64_t window_start_ = 0;
  std::uint64_t window_size_ = 0;
};

// Records in memory: the content of a chunk, or a summary.
class RecordList {
 public:
  explicit RecordList(View bytes) : bytes_(bytes) {}
  // Returns nothing at the end, and if a length is wrong or the opcode is 0, which is invalid: then ok() is false.
  // Offsets are relative to the list.
  std::optional<RecordView> next();
  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] std::size_t offset() const { return offset_; }

 private:
  View bytes_;
  std::size_t offset_ = 0;
  bool ok_ = true;
};

}  // namespace cellmirror::mcap
