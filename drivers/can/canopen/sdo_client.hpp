// The client of SDO transfers with one node: expedited and segmented. No I/O, no clock.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "drivers/can/canopen/sdo.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::can {

// One transfer at a time: download() or upload() gives the first request; receive() takes each answer and gives the
// next request; advance() gives the abort of a transfer that timed out. Every frame given has to be sent.
class SdoClient {
 public:
  enum class State : std::uint8_t { idle, busy, done, failed };

  // `node` 1..127; `timeout` > 0, for each answer.
  SdoClient(std::uint8_t node, Nanoseconds timeout);

  // Not while busy. `value`: 1..kMaxSdoValue bytes, little-endian.
  [[nodiscard]] CanFrame download(ObjectAddress address, std::span<const std::uint8_t> value, Timestamp now);
  [[nodiscard]] CanFrame upload(ObjectAddress address, Timestamp now);
  // Frames that are no answer to this transfer are ignored.
  [[nodiscard]] std::optional<CanFrame> receive(const CanFrame& frame, Timestamp now);
  [[nodiscard]] std::optional<CanFrame> advance(Timestamp now);
  // Ends a transfer without a word to the server (it restarts by itself with the next request).
  void reset() { state_ = State::idle; }

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] SdoAbort abort() const { return abort_; }  // when failed
  [[nodiscard]] ObjectAddress address() const { return address_; }
  [[nodiscard]] std::span<const std::uint8_t> value() const { return value_; }  // of a finished upload
  [[nodiscard]] Timestamp due() const { return state_ == State::busy ? deadline_ : Timestamp{}; }

 private:
  enum class Phase : std::uint8_t { download_start, download_segment, upload_start, upload_segment };

  [[nodiscard]] std::optional<CanFrame> on_download_started(const CanFrame& frame);
  [[nodiscard]] std::optional<CanFrame> on_download_segment(const CanFrame& frame);
  [[nodiscard]] std::optional<CanFrame> on_upload_started(const CanFrame& frame);
  [[nodiscard]] std::optional<CanFrame> on_upload_segment(const CanFrame& frame);
  [[nodiscard]] CanFrame next_download_segment();
  [[nodiscard]] CanFrame next_upload_segment() const;
  CanFrame abort_with(SdoAbort abort);

  std::uint8_t node_;
  Nanoseconds timeout_;
  State state_ = State::idle;
  Phase phase_ = Phase::upload_start;
  SdoAbort abort_ = SdoAbort::general_error;
  ObjectAddress address_;
  std::vector<std::uint8_t> value_;
  std::size_t sent_ = 0;
  std::size_t announced_ = 0;  // bytes that an upload told; 0: none told
  bool toggle_ = false;
  Timestamp deadline_;
};

}  // namespace cellmirror::can
