#include "sim_devices/camera/camera_reader.hpp"

#include <fmt/format.h>
#include <sys/ipc.h>
#include <sys/msg.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "ipc/wire/record.hpp"

namespace cellmirror::sim {
namespace {

constexpr Nanoseconds kBetweenLooks{100'000'000};

}  // namespace

bool CameraReader::attach(Timestamp now) {
  if (queue_ >= 0) return true;
  if (now < next_look_) return false;
  next_look_ = now + kBetweenLooks;
  queue_ = ::msgget(key_, 0);
  if (queue_ < 0) {
    reason_ = fmt::format("there is no SENSOR queue {:#x}: {}", static_cast<std::uint32_t>(key_),
                          std::generic_category().message(errno));
    return false;
  }
  reason_.clear();
  last_sequence_ = 0;  // a gateway counts from 1
  ++counters_.attachments;
  return true;
}

void CameraReader::detach() { queue_ = -1; }

std::optional<CameraRecord> CameraReader::newest(Timestamp now) {
  if (!attach(now)) return {};
  return take_ ? take_all() : newest_record();
}

std::optional<CameraRecord> CameraReader::match(std::size_t bytes) {
  const auto message = std::span(std::as_const(buffer_.text)).first(bytes);
  auto record = decode_camera_record(message);
  if (record && record->id == camera_) {
    ++counters_.records;
    return std::move(*record);
  }
  const auto header = decode_record_header(message);
  ++(header ? counters_.others : counters_.malformed);
  return {};
}

std::optional<CameraRecord> CameraReader::take_all() {
  std::optional<CameraRecord> newest;
  for (std::size_t i = 0; i < kMostAtOnce; ++i) {
    const ssize_t got = ::msgrcv(queue_, &buffer_, buffer_.text.size(), kSensorMessageType, IPC_NOWAIT | MSG_NOERROR);
    if (got >= 0) {
      if (auto record = match(static_cast<std::size_t>(got))) newest = std::move(record);
      continue;
    }
    if (errno != ENOMSG && errno != EINTR) {
      reason_ = fmt::format("the SENSOR queue cannot be read: {}", std::generic_category().message(errno));
      detach();
    }
    break;
  }
  return newest;
}

// From the newest message back to what was seen before. Messages may come and go meanwhile: the next call gets those
// that this one missed.
std::optional<CameraRecord> CameraReader::newest_record() {
  msqid_ds state{};
  if (::msgctl(queue_, IPC_STAT, &state) != 0) {
    reason_ = fmt::format("the SENSOR queue is gone: {}", std::generic_category().message(errno));
    detach();
    return {};
  }
  const std::size_t waiting = std::min<std::size_t>(state.msg_qnum, kMostAtOnce);
  std::uint64_t newest_sequence = last_sequence_;
  std::optional<CameraRecord> newest;
  for (std::size_t i = 0; i < waiting; ++i) {
    const auto place = static_cast<long>(state.msg_qnum - 1 - i);
    const ssize_t got = ::msgrcv(queue_, &buffer_, buffer_.text.size(), place, MSG_COPY | IPC_NOWAIT | MSG_NOERROR);
    if (got < 0 && (errno == ENOMSG || errno == EINTR)) continue;
    if (got < 0) {
      reason_ = errno == ENOSYS
                    ? "this kernel cannot peek at messages; use --take"
                    : fmt::format("the SENSOR queue cannot be read: {}", std::generic_category().message(errno));
      detach();
      break;
    }
    if (buffer_.type != kSensorMessageType) continue;
    const auto bytes = static_cast<std::size_t>(got);
    const auto header = decode_record_header(std::span(std::as_const(buffer_.text)).first(bytes));
    if (header && header->sequence <= last_sequence_) break;
    if (header) newest_sequence = std::max(newest_sequence, header->sequence);
    auto record = match(bytes);
    if (record && !newest) newest = std::move(record);
  }
  last_sequence_ = newest_sequence;
  return newest;
}

}  // namespace cellmirror::sim
