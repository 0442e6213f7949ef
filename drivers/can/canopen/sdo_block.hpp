// The segments of SDO block transfers as a server takes and gives them (CiA 301, 7.2.4.2.9 to 7.2.4.2.13): sub-blocks
// of numbered segments, each sub-block acknowledged as a whole. No I/O, no clock; SdoServer has the rest.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <optional>
#include <span>
#include <vector>

#include "drivers/can/canopen/sdo.hpp"

namespace cellmirror::can {

inline constexpr std::size_t kSdoSegment = 7;

// CRC-16 of block transfers: polynomial 0x1021, initial value 0, most significant bit first.
[[nodiscard]] std::uint16_t sdo_crc(std::span<const std::uint8_t> data);

// A value that a client writes.
class SdoBlockDownload {
 public:
  // Segments of a sub-block. The first byte of a segment is then at most 0x1F, or 0x81 to 0x9F for the last one, so
  // that a new request of a client that ended the transfer differs from a segment.
  static constexpr std::uint8_t kBlockSize = 31;
  [[nodiscard]] static bool is_segment(std::uint8_t first_byte) {
    return (first_byte & 0x7FU) >= 1 && (first_byte & 0x7FU) <= kBlockSize;
  }

  // `announced`: bytes of the value, 0 where the client does not say.
  void start(std::size_t announced, bool with_crc);
  struct Taken {
    bool sub_block_ends = false;  // with this segment: it is to be acknowledged
    std::uint8_t in_order = 0;    // then: the number of the last segment that came in order
  };
  [[nodiscard]] std::expected<Taken, SdoAbort> take(std::span<const std::uint8_t, 8> segment);
  [[nodiscard]] bool complete() const { return complete_; }
  // After the last segment: `unused` bytes of it do not belong to the value.
  [[nodiscard]] std::expected<std::span<const std::uint8_t>, SdoAbort> finish(std::size_t unused, std::uint16_t crc);

 private:
  std::vector<std::uint8_t> value_;
  std::size_t announced_ = 0;
  bool with_crc_ = false;
  bool complete_ = false;
  std::uint8_t in_order_ = 0;  // of this sub-block
};

// A value that a client reads.
class SdoBlockUpload {
 public:
  void start(std::vector<std::uint8_t> value, std::uint8_t block_size);
  // The first eight bytes of the next segment of the sub-block; none where it is complete.
  [[nodiscard]] std::optional<std::array<std::uint8_t, 8>> next();
  [[nodiscard]] bool sub_block_sent() const;
  // The client has the first `count` segments of the sub-block. False where more were never sent.
  [[nodiscard]] bool acknowledge(std::uint8_t count, std::uint8_t block_size);
  [[nodiscard]] bool complete() const { return start_ >= value_.size(); }
  [[nodiscard]] std::size_t unused_of_last() const;
  [[nodiscard]] std::uint16_t crc() const { return sdo_crc(value_); }

 private:
  [[nodiscard]] std::size_t next_byte() const { return start_ + kSdoSegment * sent_; }

  std::vector<std::uint8_t> value_;
  std::size_t start_ = 0;  // of the sub-block
  std::uint8_t sent_ = 0;  // segments of the sub-block
  std::uint8_t block_size_ = 1;
};

}  // namespace cellmirror::can
