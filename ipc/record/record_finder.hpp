// Finds the next record behind damage. A record is recognised by lengths that agree: that of the record, and those of
// the texts and data in it. Takes any bytes. One thread.
#pragma once

#include <cstdint>
#include <optional>

#include "ipc/record/byte_stream.hpp"
#include "ipc/record/record_stream.hpp"

namespace cellmirror::mcap {

struct FoundRecord {
  std::uint64_t offset = 0;
  bool begins_recording = false;  // at `offset` is MCAP's magic; its header follows
};

class RecordFinder {
 public:
  RecordFinder(const Source& source, const Limits& limits) : source_(source), limits_(limits) {}

  // The first that begins in [from, to): a chunk, a schema, a channel, an attachment, metadata, or a recording.
  std::optional<FoundRecord> next(std::uint64_t from, std::uint64_t to);
  std::optional<FoundRecord> next_recording(std::uint64_t from, std::uint64_t to);

 private:
  [[nodiscard]] bool recording_at(std::uint64_t offset) const;
  std::optional<FoundRecord> search(std::uint64_t from, std::uint64_t to, bool only_recordings);
  [[nodiscard]] bool record_at(std::uint64_t offset) const;
  [[nodiscard]] bool fits(std::size_t i, std::uint64_t window_at) const;

  const Source& source_;
  Limits limits_;
  Bytes window_;
};

}  // namespace cellmirror::mcap
