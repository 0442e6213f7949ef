#include "config/volume/volume_process.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

namespace cellmirror {

namespace {

constexpr const char* kExportSliceAgain = "export it again, or remove it from the folder";

std::unexpected<Error> why_reader_ended(std::optional<int> status) {
  if (status && WIFSIGNALED(*status)) {
    const int signal = WTERMSIG(*status);
    if (signal == SIGXCPU) return fail("its reader took too much CPU time", "export the series without compression");
    return fail(fmt::format("its reader ended with signal {}: the file is damaged", signal_text(signal)),
                kExportSliceAgain);
  }
  return fail("its reader ended: the file is damaged", kExportSliceAgain);
}

}  // namespace

VolumeReader installed_volume_reader() { return {program_beside_this("cellmirror-volume-reader")}; }

Result<void> VolumeProcess::start() {
  if (started_) return {};
  auto started = start_reader(reader_.program);
  if (!started) return std::unexpected(started.error());
  started_.emplace(std::move(*started));
  return {};
}

std::unexpected<Error> VolumeProcess::ended(bool too_late) {
  started_->socket.reset();
  const std::optional<int> status = started_->child.end();
  started_.reset();
  if (too_late) {
    return fail(fmt::format("its reader took more than {:g} s", std::chrono::duration<double>(reader_.longest).count()),
                kExportSliceAgain);
  }
  return why_reader_ended(status);
}

std::unexpected<Error> VolumeProcess::damaged_answer() {
  started_.reset();
  return fail("its reader's answer is damaged", kExportSliceAgain);
}

Result<void> VolumeProcess::send(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::send(started_->socket.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count > 0) {
      bytes.remove_prefix(static_cast<std::size_t>(count));
      continue;
    }
    if (errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR && errno != ENOBUFS) return ended(false);
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until_ - std::chrono::steady_clock::now()).count();
    if (left <= 0) return ended(true);
    pollfd wait{started_->socket.get(), POLLOUT, 0};
    poll(&wait, 1, static_cast<int>(left));
  }
  return {};
}

Result<void> VolumeProcess::receive(std::span<std::byte> to) {
  while (!to.empty()) {
    const ssize_t count = recv(started_->socket.get(), to.data(), to.size(), MSG_DONTWAIT);
    if (count > 0) {
      to = to.subspan(static_cast<std::size_t>(count));
      continue;
    }
    if (count == 0 || (errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR)) return ended(false);
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until_ - std::chrono::steady_clock::now()).count();
    if (left <= 0) return ended(true);
    pollfd wait{started_->socket.get(), POLLIN, 0};
    poll(&wait, 1, static_cast<int>(left));
  }
  return {};
}

Result<std::string> VolumeProcess::receive_text(std::uint64_t bytes, std::size_t most) {
  if (bytes > most) return damaged_answer();
  std::string text(bytes, '\0');
  if (auto received = receive(std::as_writable_bytes(std::span(text))); !received)
    return std::unexpected(received.error());
  return text;
}

Result<VolumeProcess::Answer> VolumeProcess::ask(SliceRequestKind kind, std::string_view bytes) {
  if (auto running = start(); !running) return std::unexpected(running.error());
  until_ = std::chrono::steady_clock::now() + reader_.longest;
  const SliceFrame request{static_cast<std::uint32_t>(kind), 0, bytes.size()};
  if (auto sent = send({reinterpret_cast<const char*>(&request), sizeof(request)}); !sent)
    return std::unexpected(sent.error());
  if (auto sent = send(bytes); !sent) return std::unexpected(sent.error());
  SliceFrame frame;
  if (auto received = receive(std::as_writable_bytes(std::span(&frame, 1))); !received)
    return std::unexpected(received.error());
  if (frame.kind < 1 || frame.kind > static_cast<std::uint32_t>(SliceAnswerKind::error)) return damaged_answer();
  const Answer answer{static_cast<SliceAnswerKind>(frame.kind), frame.bytes};
  if (answer.kind != SliceAnswerKind::error) return answer;
  const auto text = receive_text(answer.bytes, kLargestSliceError);
  if (!text) return std::unexpected(text.error());
  const auto error = decode_slice_error(*text);
  if (!error) return damaged_answer();
  return std::unexpected(*error);
}

Result<SliceHeadRead> VolumeProcess::head(std::string_view bytes, bool whole) {
  const auto answer = ask(whole ? SliceRequestKind::head_of_all : SliceRequestKind::head, bytes);
  if (!answer) return std::unexpected(answer.error());
  if (answer->kind == SliceAnswerKind::pixels) return damaged_answer();
  const auto text = receive_text(answer->bytes, kLargestSliceHead);
  if (!text) return std::unexpected(text.error());
  SliceHeadRead out{answer->kind, {}};
  if (answer->kind != SliceAnswerKind::head) return out;
  auto head = decode_slice_head(*text);
  if (!head) return damaged_answer();
  out.head = std::move(*head);
  return out;
}

Result<void> VolumeProcess::pixels(std::string_view bytes, std::uint32_t columns, std::uint32_t rows, SliceValues type,
                                   std::span<std::byte> to) {
  const auto answer = ask(SliceRequestKind::pixels, bytes);
  if (!answer) return std::unexpected(answer.error());
  SlicePixelsHead head;
  if (answer->kind != SliceAnswerKind::pixels || answer->bytes < sizeof(head)) return damaged_answer();
  if (auto received = receive(std::as_writable_bytes(std::span(&head, 1))); !received) return received;
  if (head.columns != columns || head.rows != rows || head.type != type || answer->bytes - sizeof(head) != to.size()) {
    started_.reset();
    return fail("its pixels have another size or type than its head says", kExportSliceAgain);
  }
  return receive(to);
}

}  // namespace cellmirror
