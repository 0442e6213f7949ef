#include "drivers/can/canopen/sdo_server.hpp"

#include <algorithm>
#include <utility>

#include "drivers/can/canopen/bytes.hpp"
#include "drivers/can/canopen/cob_id.hpp"

namespace cellmirror::can {
namespace {

// Client command specifiers in bits 7..5 (CiA 301, 7.2.4.3).
enum class Request : std::uint8_t {
  download_segment = 0,
  start_download = 1,
  start_upload = 2,
  upload_segment = 3,
  abort = 4,
  block_upload = 5,
  block_download = 6,
  unused = 7,
};
constexpr unsigned kDownloadStarted = 3;
constexpr unsigned kUploadStarted = 2;
constexpr unsigned kDownloadSegmentTaken = 1;
constexpr unsigned kBlockUploadAnswer = 6;
constexpr unsigned kBlockDownloadAnswer = 5;
// Subcommands in bits 1..0 of the client's block commands.
enum class BlockStep : std::uint8_t { initiate = 0, end = 1, acknowledge = 2, start = 3 };
// A sub-block is sent in bursts: 127 frames at once are more than the queue of a CAN interface holds.
constexpr int kBurst = 8;
constexpr Nanoseconds kBurstPause{1'000'000};
constexpr std::size_t kSegment = kSdoSegment;

BlockStep block_step(const CanFrame& frame) { return static_cast<BlockStep>(frame.data[0] & 3U); }

SdoAbort missing(const ObjectDictionary& objects, ObjectAddress address) {
  return objects.has_index(address.index) ? SdoAbort::no_such_subindex : SdoAbort::no_such_object;
}

}  // namespace

std::expected<std::vector<std::uint8_t>, SdoAbort> read_object(const ObjectDictionary& objects, ObjectAddress address) {
  const ObjectEntry* entry = objects.find(address);
  if (entry == nullptr) return std::unexpected(missing(objects, address));
  if (entry->access == ObjectAccess::write_only) return std::unexpected(SdoAbort::write_only);
  if (entry->value.empty()) return std::unexpected(SdoAbort::no_data);
  return entry->value;
}

std::optional<SdoAbort> check_write(const ObjectDictionary& objects, ObjectAddress address,
                                    std::span<const std::uint8_t> value) {
  const ObjectEntry* entry = objects.find(address);
  if (entry == nullptr) return missing(objects, address);
  if (entry->access == ObjectAccess::constant || entry->access == ObjectAccess::read_only) return SdoAbort::read_only;
  const std::size_t size = size_of(entry->type);
  if (size == 0) return {};
  if (value.size() > size) return SdoAbort::too_long;
  if (value.size() < size) return SdoAbort::too_short;
  if (!is_integer_type(entry->type)) return {};
  const std::uint64_t raw = get_le(value, size);
  const std::int64_t number =
      is_signed_type(entry->type) ? sign_extended(raw, 8 * size) : static_cast<std::int64_t>(raw);
  if (entry->high_limit && number > *entry->high_limit) return SdoAbort::value_too_high;
  if (entry->low_limit && number < *entry->low_limit) return SdoAbort::value_too_low;
  return {};
}

std::optional<SdoAbort> write_object(ObjectDictionary& objects, ObjectAddress address,
                                     std::span<const std::uint8_t> value) {
  if (const auto abort = check_write(objects, address, value)) return abort;
  objects.find(address)->value.assign(value.begin(), value.end());
  return {};
}

SdoServer::SdoServer(std::uint8_t node, SdoObjects& objects) : node_(node), objects_(&objects) {
  CELLMIRROR_EXPECTS(node >= 1 && node <= kMaxNodeId);
}

std::optional<CanFrame> SdoServer::receive(const CanFrame& frame, Timestamp now) {
  if (!is_service_frame(frame) || frame.id != kSdoRequestBase + node_ || frame.length != 8) return {};
  deadline_ = now + kTimeout;
  burst_due_ = now;
  burst_ = 0;
  if (transfer_ == Transfer::block_download && SdoBlockDownload::is_segment(frame.data[0])) {
    return block_download_segment(frame);
  }
  return answer_request(frame);
}

std::optional<CanFrame> SdoServer::answer_request(const CanFrame& frame) {
  switch (static_cast<Request>(frame.data[0] >> 5)) {
    case Request::start_download:
      return start_download(frame);
    case Request::download_segment:
      return download_segment(frame);
    case Request::start_upload:
      return start_upload(frame);
    case Request::upload_segment:
      return upload_segment(frame);
    case Request::abort:
      transfer_ = Transfer::none;
      return {};
    case Request::block_upload:
      return block_upload(frame);
    case Request::block_download:
      return (frame.data[0] & 1U) == 0 ? start_block_download(frame) : end_block_download(frame);
    case Request::unused:
      break;
  }
  return refuse(sdo_address(frame), SdoAbort::unknown_command);
}

std::optional<CanFrame> SdoServer::advance(Timestamp now) {
  if (transfer_ == Transfer::none) return {};
  if (now >= deadline_) return refuse(address_, SdoAbort::timed_out);
  if (transfer_ != Transfer::block_upload || now < burst_due_) return {};
  const auto segment = block_upload_.next();
  if (!segment) return {};
  if (++burst_ == kBurst) {
    burst_ = 0;
    burst_due_ = now + kBurstPause;
  }
  return make_frame(kSdoResponseBase + node_, *segment);
}

Timestamp SdoServer::next_due() const {
  if (transfer_ == Transfer::none) return {};
  const bool sends = transfer_ == Transfer::block_upload && !block_upload_.sub_block_sent();
  return sends ? std::min(burst_due_, deadline_) : deadline_;
}

CanFrame SdoServer::start_download(const CanFrame& frame) {
  const unsigned command = frame.data[0];
  const ObjectAddress address = sdo_address(frame);
  const bool expedited = (command & 2U) != 0;
  const bool size_told = (command & 1U) != 0;
  if (expedited) {
    std::size_t size = size_told ? 4 - (command >> 2 & 3U) : 4;
    if (!size_told) {
      // Without a told size the value fills the object: as many bytes as the object has now.
      if (const auto now = objects_->read(address); now && now->size() <= 4) size = now->size();
    }
    const std::span<const std::uint8_t> value(frame.data.data() + 4, size);
    if (const auto abort = objects_->write(address, value)) return refuse(address, *abort);
    transfer_ = Transfer::none;
    return answer(kDownloadStarted << 5, address);
  }
  announced_ = size_told ? get_le32(std::span(frame.data).subspan(4)) : 0;
  if (announced_ > kMaxSdoValue) return refuse(address, SdoAbort::out_of_memory);
  transfer_ = Transfer::download;
  address_ = address;
  value_.clear();
  toggle_ = false;
  return answer(kDownloadStarted << 5, address);
}

CanFrame SdoServer::download_segment(const CanFrame& frame) {
  const unsigned command = frame.data[0];
  if (transfer_ != Transfer::download) return refuse(address_, SdoAbort::unknown_command);
  if (((command >> 4 & 1U) != 0) != toggle_) return refuse(address_, SdoAbort::toggle_not_alternated);
  const std::size_t size = kSegment - (command >> 1 & 7U);
  if (value_.size() + size > kMaxSdoValue) return refuse(address_, SdoAbort::out_of_memory);
  value_.insert(value_.end(), frame.data.begin() + 1, frame.data.begin() + 1 + static_cast<std::ptrdiff_t>(size));
  const unsigned taken = kDownloadSegmentTaken << 5 | (toggle_ ? 1U << 4 : 0U);
  toggle_ = !toggle_;
  if ((command & 1U) != 0) {
    if (announced_ != 0 && announced_ != value_.size()) return refuse(address_, SdoAbort::length_mismatch);
    if (value_.empty()) return refuse(address_, SdoAbort::too_short);
    if (const auto abort = objects_->write(address_, value_)) return refuse(address_, *abort);
    transfer_ = Transfer::none;
  }
  return make_frame(kSdoResponseBase + node_, {static_cast<std::uint8_t>(taken), 0, 0, 0, 0, 0, 0, 0});
}

CanFrame SdoServer::start_upload(const CanFrame& frame) {
  const ObjectAddress address = sdo_address(frame);
  auto value = objects_->read(address);
  if (!value) return refuse(address, value.error());
  if (value->empty()) return refuse(address, SdoAbort::no_data);
  if (value->size() <= 4) {
    transfer_ = Transfer::none;
    const auto unused = static_cast<unsigned>(4 - value->size());
    CanFrame given = answer(kUploadStarted << 5 | unused << 2 | 3U, address);
    std::copy(value->begin(), value->end(), given.data.begin() + 4);
    return given;
  }
  transfer_ = Transfer::upload;
  address_ = address;
  value_ = std::move(*value);
  sent_ = 0;
  toggle_ = false;
  CanFrame given = answer(kUploadStarted << 5 | 1U, address);
  put_le(std::span(given.data).subspan(4), value_.size(), 4);
  return given;
}

CanFrame SdoServer::upload_segment(const CanFrame& frame) {
  if (transfer_ != Transfer::upload) return refuse(address_, SdoAbort::unknown_command);
  if (((frame.data[0] >> 4 & 1U) != 0) != toggle_) return refuse(address_, SdoAbort::toggle_not_alternated);
  const std::size_t take = std::min(kSegment, value_.size() - sent_);
  const bool last = sent_ + take == value_.size();
  CanFrame given = make_frame(kSdoResponseBase + node_, {0, 0, 0, 0, 0, 0, 0, 0});
  given.data[0] = static_cast<std::uint8_t>((toggle_ ? 1U << 4 : 0U) | (kSegment - take) << 1 | (last ? 1U : 0U));
  std::copy_n(value_.begin() + static_cast<std::ptrdiff_t>(sent_), take, given.data.begin() + 1);
  sent_ += take;
  toggle_ = !toggle_;
  if (last) transfer_ = Transfer::none;
  return given;
}

CanFrame SdoServer::start_block_download(const CanFrame& frame) {
  const ObjectAddress address = sdo_address(frame);
  const std::size_t announced = (frame.data[0] & 2U) != 0 ? get_le32(std::span(frame.data).subspan(4)) : 0;
  if (announced > kMaxSdoValue) return refuse(address, SdoAbort::out_of_memory);
  const bool with_crc = (frame.data[0] & 4U) != 0;
  transfer_ = Transfer::block_download;
  address_ = address;
  block_download_.start(announced, with_crc);
  CanFrame given = answer(kBlockDownloadAnswer << 5 | 4U, address);  // bit 2: this server knows the CRC
  given.data[4] = SdoBlockDownload::kBlockSize;
  return given;
}

std::optional<CanFrame> SdoServer::block_download_segment(const CanFrame& frame) {
  const auto taken = block_download_.take(std::span<const std::uint8_t, 8>(frame.data.data(), 8));
  if (!taken) return refuse(address_, taken.error());
  if (!taken->sub_block_ends) return {};
  if (block_download_.complete()) transfer_ = Transfer::block_download_end;
  return make_frame(kSdoResponseBase + node_,
                    {kBlockDownloadAnswer << 5 | 2U, taken->in_order, SdoBlockDownload::kBlockSize, 0, 0, 0, 0, 0});
}

CanFrame SdoServer::end_block_download(const CanFrame& frame) {
  if (transfer_ != Transfer::block_download_end) return refuse(address_, SdoAbort::unknown_command);
  const auto value = block_download_.finish(frame.data[0] >> 2 & 7U, get_le16(std::span(frame.data).subspan(1)));
  if (!value) return refuse(address_, value.error());
  if (const auto abort = objects_->write(address_, *value)) return refuse(address_, *abort);
  transfer_ = Transfer::none;
  return make_frame(kSdoResponseBase + node_, {kBlockDownloadAnswer << 5 | 1U, 0, 0, 0, 0, 0, 0, 0});
}

std::optional<CanFrame> SdoServer::block_upload(const CanFrame& frame) {
  switch (block_step(frame)) {
    case BlockStep::initiate:
      return start_block_upload(frame);
    case BlockStep::start:
      if (transfer_ != Transfer::block_upload_start) break;
      transfer_ = Transfer::block_upload;
      return {};
    case BlockStep::acknowledge:
      if (transfer_ != Transfer::block_upload) break;
      return block_upload_acknowledged(frame);
    case BlockStep::end:
      if (transfer_ != Transfer::block_upload_end) break;
      transfer_ = Transfer::none;
      return {};
  }
  return refuse(address_, SdoAbort::unknown_command);
}

CanFrame SdoServer::start_block_upload(const CanFrame& frame) {
  const ObjectAddress address = sdo_address(frame);
  const std::uint8_t block_size = frame.data[4];
  if (block_size < 1 || block_size > 127) return refuse(address, SdoAbort::block_size);
  auto value = objects_->read(address);
  if (!value) return refuse(address, value.error());
  if (value->empty()) return refuse(address, SdoAbort::no_data);
  CanFrame given = answer(kBlockUploadAnswer << 5 | 4U | 2U, address);
  put_le(std::span(given.data).subspan(4), value->size(), 4);
  transfer_ = Transfer::block_upload_start;
  address_ = address;
  block_upload_.start(std::move(*value), block_size);
  return given;
}

std::optional<CanFrame> SdoServer::block_upload_acknowledged(const CanFrame& frame) {
  const std::uint8_t block_size = frame.data[2];
  if (block_size < 1 || block_size > 127) return refuse(address_, SdoAbort::block_size);
  if (!block_upload_.acknowledge(frame.data[1], block_size)) return refuse(address_, SdoAbort::sequence_number);
  if (!block_upload_.complete()) return {};
  transfer_ = Transfer::block_upload_end;
  const auto command = static_cast<std::uint8_t>(kBlockUploadAnswer << 5 | block_upload_.unused_of_last() << 2 | 1U);
  CanFrame given = make_frame(kSdoResponseBase + node_, {command, 0, 0, 0, 0, 0, 0, 0});
  put_le(std::span(given.data).subspan(1), block_upload_.crc(), 2);
  return given;
}

CanFrame SdoServer::answer(unsigned command, ObjectAddress address) const {
  CanFrame frame =
      make_frame(kSdoResponseBase + node_, {static_cast<std::uint8_t>(command), 0, 0, address.subindex, 0, 0, 0, 0});
  put_le(std::span(frame.data).subspan(1), address.index, 2);
  return frame;
}

CanFrame SdoServer::refuse(ObjectAddress address, SdoAbort abort) {
  transfer_ = Transfer::none;
  return encode_sdo_abort(kSdoResponseBase + node_, address, abort);
}

}  // namespace cellmirror::can
