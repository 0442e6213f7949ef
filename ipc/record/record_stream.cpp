#include "ipc/record/record_stream.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ipc/record/decode.hpp"

namespace cellmirror::mcap {

namespace {

constexpr std::uint64_t kWindow = std::uint64_t{1} << 20;

}  // namespace

RecordStream::RecordStream(const Source& source, std::uint64_t from, std::uint64_t end, const Limits& limits)
    : source_(source), offset_(from), end_(std::min(end, source.size())), limits_(limits) {}

Result<View> RecordStream::bytes(std::uint64_t size) {
  if (offset_ < window_start_ || offset_ + size > window_start_ + window_size_) {
    const std::uint64_t wanted = std::min(std::max(size, kWindow), end_ - offset_);
    if (window_.size() < wanted) window_.resize(wanted);
    window_size_ = 0;
    if (auto got = source_.read(offset_, std::span(window_).first(wanted)); !got) return std::unexpected(got.error());
    window_start_ = offset_;
    window_size_ = wanted;
  }
  return View(window_).subspan(offset_ - window_start_, size);
}

Result<std::optional<RecordView>> RecordStream::next() {
  if (offset_ >= end_) return std::optional<RecordView>();
  const std::uint64_t left = end_ - offset_;
  if (left < kRecordHead) return fail(fmt::format("at byte {}: the file ends within the head of a record", offset_));
  const auto head = bytes(kRecordHead);
  if (!head) return std::unexpected(head.error());
  Decoder from(*head);
  RecordView out;
  out.opcode = from.number<std::uint8_t>();
  out.offset = offset_;
  const auto length = from.number<std::uint64_t>();
  // A machine that lost its power leaves zeros.
  if (out.opcode == 0) return fail(fmt::format("at byte {}: what follows is no record", offset_));
  if (length > left - kRecordHead) {
    return fail(fmt::format("at byte {}: a record of kind {:#04x} says that it has {} bytes; the file has {} more",
                            offset_, out.opcode, length, left - kRecordHead));
  }
  if (length > limits_.record_bytes) {
    return fail(fmt::format("at byte {}: a record of {} bytes is more than the {} that are accepted", offset_, length,
                            limits_.record_bytes));
  }
  const auto whole = bytes(kRecordHead + length);
  if (!whole) return std::unexpected(whole.error());
  out.content = whole->subspan(kRecordHead);
  offset_ += kRecordHead + length;
  return std::optional(out);
}

std::optional<RecordView> RecordList::next() {
  if (!ok_ || offset_ == bytes_.size()) return std::nullopt;
  Decoder from(bytes_.subspan(offset_));
  RecordView out;
  out.opcode = from.number<std::uint8_t>();
  out.offset = offset_;
  out.content = from.bytes(from.number<std::uint64_t>());
  ok_ = from.ok() && out.opcode != 0;
  if (!ok_) return std::nullopt;
  offset_ += kRecordHead + out.content.size();
  return out;
}

}  // namespace cellmirror::mcap
