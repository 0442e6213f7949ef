// Reads a recording from its first byte on, with or without a summary, and passes what is whole to a visitor. Where
// something is wrong it goes on behind it where that is possible. Takes any bytes. One thread; not for the tick.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ipc/record/compression.hpp"
#include "ipc/record/record_stream.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::mcap {

struct Fault {
  std::uint64_t offset = 0;  // in the file, of the record that is wrong
  std::string what;          // without the offset
};

class Faults {
 public:
  static constexpr std::size_t kKept = 100;
  void add(std::uint64_t offset, std::string what) {
    ++count_;
    if (!full()) kept_.push_back({offset, std::move(what)});
  }
  // Counts one more fault without a text; only if full(). Formatting every text would take longer than reading.
  void add_another() { ++count_; }
  [[nodiscard]] bool full() const { return kept_.size() >= kKept; }
  [[nodiscard]] const std::vector<Fault>& first() const { return kept_; }
  [[nodiscard]] std::uint64_t count() const { return count_; }

 private:
  std::vector<Fault> kept_;
  std::uint64_t count_ = 0;
};

// Schemas and channels by id, the first of each.
struct Catalogue {
  std::map<std::uint16_t, Schema> schemas;
  std::map<std::uint16_t, Channel> channels;

  // Nothing, or what is wrong with it.
  std::string add(Schema schema);
  std::string add(Channel channel);
  // Null where it is not known.
  [[nodiscard]] const Schema* schema_of(const Channel& channel) const;
};

// Views are valid during the call.
class Visitor {
 public:
  virtual ~Visitor() = default;
  virtual void on_schema(const Schema& /*schema*/) {}
  virtual void on_channel(const Channel& /*channel*/) {}
  // Its channel is known.
  virtual void on_message(const Message& /*message*/, const Channel& /*channel*/) {}
  virtual void on_attachment(const Attachment& /*attachment*/, const RecordView& /*record*/) {}
  virtual void on_metadata(const Metadata& /*metadata*/, const RecordView& /*record*/) {}
};

struct ScanReport {
  Header header;
  Catalogue catalogue;
  Statistics statistics;           // of what was passed on
  std::vector<ChunkIndex> chunks;  // whole ones, with the channels of their messages, but not where these are
  bool chunks_have_all = true;     // every message that was passed on is in one of them, and nothing in these is wrong
  std::uint64_t messages_outside = 0;  // of no chunk
  std::uint64_t out_of_order = 0;      // messages with a log time before that of the message before
  std::uint64_t recordings = 1;        // more where files were joined; ids of the later ones are mapped
  std::uint64_t chunks_lost = 0;
  std::uint64_t chunks_left_out = 0;  // Limits::leave_out_beyond
  std::uint64_t whole_until = 0;      // the end of the last whole record that was read in order
  bool ended = false;                 // a footer and the closing magic are there
  Faults faults;
};

// One chunk: its content, decompressed and checked against its CRC. `record` outlives the result, which is valid until
// the next call.
class ChunkOpener {
 public:
  ChunkOpener(const Limits& limits, std::uint64_t file_bytes)
      : limits_(limits), file_bytes_(file_bytes), left_(limits.most_decompressed(file_bytes)) {}
  Result<View> open(const Chunk& chunk);
  // True if the last open() failed because of the limit of decompressed bytes, not because the chunk is faulty.
  [[nodiscard]] bool exhausted() const { return exhausted_; }

 private:
  Limits limits_;
  std::uint64_t file_bytes_;
  std::uint64_t left_;  // bytes
  bool exhausted_ = false;
  Decompressor decompressor_;
};

// Fails if the source is not an MCAP file, and if its chunks exceed the limit of decompressed bytes. All other faults
// are in the report.
[[nodiscard]] Result<ScanReport> scan(const Source& source, const Limits& limits, Visitor& visitor);

}  // namespace cellmirror::mcap
