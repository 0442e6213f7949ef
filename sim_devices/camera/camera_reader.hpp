// Reads a camera's records from the SENSOR channel of the gateway (docs/messages.md, kind 4): waits for the queue, and
// detects its removal.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "ipc/wire/camera_record.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::sim {

// One thread.
class CameraReader {
 public:
  struct Counters {
    std::uint64_t records = 0;      // of this camera
    std::uint64_t others = 0;       // records of other kinds and cameras
    std::uint64_t malformed = 0;    // no records
    std::uint64_t attachments = 0;  // how often the queue was found
  };

  // `take`: removes everything from the channel; otherwise it only peeks.
  CameraReader(std::int32_t key, std::string camera, bool take) : key_(key), camera_(std::move(camera)), take_(take) {}

  // The newest record that came since the last call; never waits. At most kMostAtOnce messages are read.
  [[nodiscard]] std::optional<CameraRecord> newest(Timestamp now);
  [[nodiscard]] const Counters& counters() const { return counters_; }
  // Why there is no queue, in words; empty while there is one.
  [[nodiscard]] const std::string& reason() const { return reason_; }

 private:
  static constexpr std::size_t kMostAtOnce = 4096;
  struct Buffer {
    long type = 0;
    std::array<std::byte, kMaxRecordBytes> text{};
  };

  bool attach(Timestamp now);
  void detach();
  [[nodiscard]] std::optional<CameraRecord> newest_record();
  [[nodiscard]] std::optional<CameraRecord> take_all();
  // Of message `bytes` long in the buffer: whether it is this camera's.
  [[nodiscard]] std::optional<CameraRecord> match(std::size_t bytes);

  std::int32_t key_;
  std::string camera_;
  bool take_;
  int queue_ = -1;
  Timestamp next_look_;
  std::uint64_t last_sequence_ = 0;  // of the newest record of any kind
  Counters counters_;
  std::string reason_;
  Buffer buffer_;
};

}  // namespace cellmirror::sim
