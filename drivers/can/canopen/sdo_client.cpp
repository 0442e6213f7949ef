#include "drivers/can/canopen/sdo_client.hpp"

#include <algorithm>

#include "drivers/can/canopen/bytes.hpp"
#include "drivers/can/canopen/cob_id.hpp"

namespace cellmirror::can {
namespace {

// Command specifiers in bits 7..5 (CiA 301, 7.2.4.3).
constexpr unsigned kStartDownload = 1;         // client
constexpr unsigned kStartUpload = 2;           // client
constexpr unsigned kUploadSegment = 3;         // client
constexpr unsigned kDownloadStarted = 3;       // server
constexpr unsigned kDownloadSegmentTaken = 1;  // server
constexpr unsigned kUploadStarted = 2;         // server
constexpr unsigned kUploadSegmentGiven = 0;    // server
constexpr std::size_t kSegment = 7;

CanFrame request(std::uint8_t node, unsigned command, ObjectAddress address) {
  CanFrame frame =
      make_frame(kSdoRequestBase + node, {static_cast<std::uint8_t>(command), 0, 0, address.subindex, 0, 0, 0, 0});
  put_le(std::span(frame.data).subspan(1), address.index, 2);
  return frame;
}

}  // namespace

SdoClient::SdoClient(std::uint8_t node, Nanoseconds timeout) : node_(node), timeout_(timeout) {
  CELLMIRROR_EXPECTS(node >= 1 && node <= kMaxNodeId && timeout.count() > 0);
}

CanFrame SdoClient::download(ObjectAddress address, std::span<const std::uint8_t> value, Timestamp now) {
  CELLMIRROR_EXPECTS(state_ != State::busy && !value.empty() && value.size() <= kMaxSdoValue);
  state_ = State::busy;
  phase_ = Phase::download_start;
  address_ = address;
  value_.assign(value.begin(), value.end());
  deadline_ = now + timeout_;
  if (value.size() <= 4) {  // expedited, size told
    const auto unused = static_cast<unsigned>(4 - value.size());
    CanFrame frame = request(node_, kStartDownload << 5 | unused << 2 | 3U, address);
    std::copy(value.begin(), value.end(), frame.data.begin() + 4);
    return frame;
  }
  CanFrame frame = request(node_, kStartDownload << 5 | 1U, address);
  put_le(std::span(frame.data).subspan(4), value.size(), 4);
  return frame;
}

CanFrame SdoClient::upload(ObjectAddress address, Timestamp now) {
  CELLMIRROR_EXPECTS(state_ != State::busy);
  state_ = State::busy;
  phase_ = Phase::upload_start;
  address_ = address;
  value_.clear();
  deadline_ = now + timeout_;
  return request(node_, kStartUpload << 5, address);
}

std::optional<CanFrame> SdoClient::receive(const CanFrame& frame, Timestamp now) {
  if (state_ != State::busy || !is_service_frame(frame) || frame.id != kSdoResponseBase + node_ || frame.length != 8) {
    return {};
  }
  if (frame.data[0] == kSdoAbortCommand) {
    if (sdo_address(frame) != address_) return {};  // of an earlier transfer
    state_ = State::failed;
    abort_ = static_cast<SdoAbort>(get_le32(std::span(frame.data).subspan(4)));
    return {};
  }
  deadline_ = now + timeout_;
  switch (phase_) {
    case Phase::download_start:
      return on_download_started(frame);
    case Phase::download_segment:
      return on_download_segment(frame);
    case Phase::upload_start:
      return on_upload_started(frame);
    case Phase::upload_segment:
      return on_upload_segment(frame);
  }
  return {};
}

std::optional<CanFrame> SdoClient::on_download_started(const CanFrame& frame) {
  if (frame.data[0] >> 5 != kDownloadStarted) return abort_with(SdoAbort::unknown_command);
  if (sdo_address(frame) != address_) return {};  // a late answer to an earlier transfer
  if (value_.size() <= 4) {
    state_ = State::done;
    return {};
  }
  phase_ = Phase::download_segment;
  sent_ = 0;
  toggle_ = false;
  return next_download_segment();
}

std::optional<CanFrame> SdoClient::on_download_segment(const CanFrame& frame) {
  if (frame.data[0] >> 5 != kDownloadSegmentTaken) return abort_with(SdoAbort::unknown_command);
  if (((frame.data[0] >> 4 & 1U) != 0) != toggle_) return abort_with(SdoAbort::toggle_not_alternated);
  sent_ += std::min(kSegment, value_.size() - sent_);
  toggle_ = !toggle_;
  if (sent_ == value_.size()) {
    state_ = State::done;
    return {};
  }
  return next_download_segment();
}

CanFrame SdoClient::next_download_segment() {
  const std::size_t take = std::min(kSegment, value_.size() - sent_);
  const bool last = sent_ + take == value_.size();
  CanFrame frame = make_frame(kSdoRequestBase + node_, {0, 0, 0, 0, 0, 0, 0, 0});
  frame.data[0] = static_cast<std::uint8_t>((toggle_ ? 1U << 4 : 0U) | (kSegment - take) << 1 | (last ? 1U : 0U));
  std::copy_n(value_.begin() + static_cast<std::ptrdiff_t>(sent_), take, frame.data.begin() + 1);
  return frame;
}

std::optional<CanFrame> SdoClient::on_upload_started(const CanFrame& frame) {
  const unsigned command = frame.data[0];
  if (command >> 5 != kUploadStarted) return abort_with(SdoAbort::unknown_command);
  if (sdo_address(frame) != address_) return {};
  const bool expedited = (command & 2U) != 0;
  const bool size_told = (command & 1U) != 0;
  if (expedited) {
    const std::size_t size = size_told ? 4 - (command >> 2 & 3U) : 4;
    value_.assign(frame.data.begin() + 4, frame.data.begin() + 4 + static_cast<std::ptrdiff_t>(size));
    state_ = State::done;
    return {};
  }
  announced_ = size_told ? get_le32(std::span(frame.data).subspan(4)) : 0;
  if (announced_ > kMaxSdoValue) return abort_with(SdoAbort::out_of_memory);
  phase_ = Phase::upload_segment;
  toggle_ = false;
  return next_upload_segment();
}

CanFrame SdoClient::next_upload_segment() const {
  const unsigned command = kUploadSegment << 5 | (toggle_ ? 1U << 4 : 0U);
  return make_frame(kSdoRequestBase + node_, {static_cast<std::uint8_t>(command), 0, 0, 0, 0, 0, 0, 0});
}

std::optional<CanFrame> SdoClient::on_upload_segment(const CanFrame& frame) {
  const unsigned command = frame.data[0];
  if (command >> 5 != kUploadSegmentGiven) return abort_with(SdoAbort::unknown_command);
  if (((command >> 4 & 1U) != 0) != toggle_) return abort_with(SdoAbort::toggle_not_alternated);
  const std::size_t size = kSegment - (command >> 1 & 7U);
  if (value_.size() + size > kMaxSdoValue) return abort_with(SdoAbort::out_of_memory);
  value_.insert(value_.end(), frame.data.begin() + 1, frame.data.begin() + 1 + static_cast<std::ptrdiff_t>(size));
  if ((command & 1U) != 0) {
    if (announced_ != 0 && announced_ != value_.size()) return abort_with(SdoAbort::length_mismatch);
    state_ = State::done;
    return {};
  }
  toggle_ = !toggle_;
  return next_upload_segment();
}

std::optional<CanFrame> SdoClient::advance(Timestamp now) {
  if (state_ != State::busy || now < deadline_) return {};
  return abort_with(SdoAbort::timed_out);
}

CanFrame SdoClient::abort_with(SdoAbort abort) {
  state_ = State::failed;
  abort_ = abort;
  return encode_sdo_abort(kSdoRequestBase + node_, address_, abort);
}

}  // namespace cellmirror::can
