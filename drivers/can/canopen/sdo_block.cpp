#include "drivers/can/canopen/sdo_block.hpp"

#include <algorithm>
#include <utility>

#include "rt_core/base/contract.hpp"

namespace cellmirror::can {
namespace {

constexpr std::uint8_t kLastSegment = 0x80;

}  // namespace

std::uint16_t sdo_crc(std::span<const std::uint8_t> data) {
  unsigned crc = 0;
  for (const std::uint8_t byte : data) {
    crc ^= static_cast<unsigned>(byte) << 8U;
    for (int bit = 0; bit < 8; ++bit) crc = (crc << 1U) ^ ((crc & 0x8000U) != 0 ? 0x1021U : 0U);
    crc &= 0xFFFFU;
  }
  return static_cast<std::uint16_t>(crc);
}

void SdoBlockDownload::start(std::size_t announced, bool with_crc) {
  value_.clear();
  announced_ = announced;
  with_crc_ = with_crc;
  complete_ = false;
  in_order_ = 0;
}

std::expected<SdoBlockDownload::Taken, SdoAbort> SdoBlockDownload::take(std::span<const std::uint8_t, 8> segment) {
  CELLMIRROR_EXPECTS(is_segment(segment[0]) && !complete_);
  const auto number = static_cast<std::uint8_t>(segment[0] & 0x7FU);
  const bool last = (segment[0] & kLastSegment) != 0;
  const bool in_order = number == in_order_ + 1;
  if (in_order) {
    // The last segment may be filled up beyond the value.
    if (value_.size() + kSdoSegment > kMaxSdoValue + kSdoSegment - 1) return std::unexpected(SdoAbort::out_of_memory);
    value_.insert(value_.end(), segment.begin() + 1, segment.end());
    in_order_ = number;
    complete_ = last;
  }
  if (!last && number < kBlockSize) return Taken{};
  // What came out of order is sent again, as segments 1, 2, ... of the next sub-block.
  return Taken{true, std::exchange(in_order_, std::uint8_t{0})};
}

std::expected<std::span<const std::uint8_t>, SdoAbort> SdoBlockDownload::finish(std::size_t unused, std::uint16_t crc) {
  CELLMIRROR_EXPECTS(complete_);
  if (unused >= kSdoSegment) return std::unexpected(SdoAbort::length_mismatch);
  value_.resize(value_.size() - unused);
  if (announced_ != 0 && announced_ != value_.size()) return std::unexpected(SdoAbort::length_mismatch);
  if (with_crc_ && sdo_crc(value_) != crc) return std::unexpected(SdoAbort::crc_error);
  return std::span<const std::uint8_t>(value_);
}

void SdoBlockUpload::start(std::vector<std::uint8_t> value, std::uint8_t block_size) {
  CELLMIRROR_EXPECTS(!value.empty() && block_size >= 1 && block_size <= 127);
  value_ = std::move(value);
  start_ = 0;
  sent_ = 0;
  block_size_ = block_size;
}

bool SdoBlockUpload::sub_block_sent() const { return sent_ == block_size_ || next_byte() >= value_.size(); }

std::optional<std::array<std::uint8_t, 8>> SdoBlockUpload::next() {
  if (sub_block_sent()) return {};
  const std::size_t from = next_byte();
  const std::size_t count = std::min(kSdoSegment, value_.size() - from);
  std::array<std::uint8_t, 8> segment{};
  const bool last = from + count == value_.size();
  segment[0] = static_cast<std::uint8_t>(++sent_ | (last ? kLastSegment : 0U));
  std::copy_n(value_.begin() + static_cast<std::ptrdiff_t>(from), count, segment.begin() + 1);
  return segment;
}

bool SdoBlockUpload::acknowledge(std::uint8_t count, std::uint8_t block_size) {
  CELLMIRROR_EXPECTS(block_size >= 1 && block_size <= 127);
  if (count > sent_) return false;
  start_ = std::min(value_.size(), start_ + kSdoSegment * count);
  sent_ = 0;
  block_size_ = block_size;
  return true;
}

std::size_t SdoBlockUpload::unused_of_last() const { return (kSdoSegment - value_.size() % kSdoSegment) % kSdoSegment; }

}  // namespace cellmirror::can
