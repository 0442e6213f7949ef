#include "ipc/web/connection.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <exception>
#include <utility>

#include "ipc/web/peer.hpp"
#include "ipc/web/server_message.hpp"

namespace cellmirror::web {

namespace {

constexpr Nanoseconds kDrainTime{1'000'000'000};
constexpr Nanoseconds kCloseTime{2'000'000'000};
constexpr std::size_t kMostDrained = 256 * 1024;
constexpr std::size_t kReadBytes = 16 * 1024;

// No request may end the gateway.
Answer guarded(const Work& work) {
  try {
    return work();
  } catch (const std::exception& error) {
    return text_answer(500, std::string("unexpected failure: ") + error.what());
  }
}

}  // namespace

Connection::Connection(Descriptor socket, std::uint64_t number, ServerContext& context, Timestamp now)
    : socket_(std::move(socket)),
      number_(number),
      context_(context),
      since_(now),
      last_received_(now),
      last_ping_(now),
      now_(now) {}

Connection::~Connection() {
  if (session_ || foxglove_) context_.counters.clients.fetch_sub(1, std::memory_order_relaxed);
}

short Connection::wanted_events() const {
  const bool reads = stage_ != Stage::waiting && stage_ != Stage::answering && stage_ != Stage::over;
  const bool writes = !out_.empty() || (is_foxglove() && !closing_ && foxglove_->waiting());
  return static_cast<short>((reads ? POLLIN : 0) | (writes ? POLLOUT : 0));
}

Timestamp Connection::deadline() const {
  switch (stage_) {
    case Stage::head:
    case Stage::body:
      return since_ + patience().request;
    case Stage::waiting:
      return since_ + patience().answer;
    case Stage::answering:
      return std::min(since_ + patience().answer,
                      blocked_since_ ? *blocked_since_ + patience().sending : now_ + patience().sending);
    case Stage::draining:
      return since_ + kDrainTime;
    case Stage::live: {
      Timestamp next = last_received_ + patience().silence;
      next = std::min(next, std::max(last_received_, last_ping_) + patience().ping);
      if (blocked_since_) next = std::min(next, *blocked_since_ + patience().sending);
      if (closing_) next = std::min(next, since_ + kCloseTime);
      return next;
    }
    case Stage::over:
      break;
  }
  return now_;
}

void Connection::cut() {
  count(context_.counters.cut);
  stage_ = Stage::over;
}

void Connection::check_time(Timestamp now) {
  now_ = now;
  if (over() || now < deadline()) return;
  switch (stage_) {
    case Stage::head:
    case Stage::body:
      if (in_.empty() && stage_ == Stage::head) {
        stage_ = Stage::over;  // browsers open spare connections
        return;
      }
      count(context_.counters.cut);
      return answer(text_answer(408, "the request took too long"));
    case Stage::waiting:
      return answer(
          text_answer(504, "no answer within the time limit; cellmirror status shows the state of the gateway"));
    case Stage::draining:
      stage_ = Stage::over;
      return;
    case Stage::live:
      break;
    default:
      return cut();
  }
  const bool stalled = blocked_since_ && now - *blocked_since_ >= patience().sending;
  if (closing_ || stalled || now - last_received_ >= patience().silence) return cut();
  last_ping_ = now;
  out_.push(frame(Opcode::ping, {}));
  write_some(now);
}

void Connection::handle_events(short events, Timestamp now) {
  now_ = now;
  if ((events & POLLIN) != 0) {
    read_some(now);
  } else if ((events & (POLLERR | POLLHUP | POLLNVAL)) != 0) {
    stage_ = Stage::over;
  }
  if (!over() && !out_.empty()) write_some(now);
  if (is_foxglove()) send_topics();
}

void Connection::read_some(Timestamp now) {
  std::array<char, kReadBytes> buffer{};
  const ssize_t got = ::recv(fd(), buffer.data(), buffer.size(), MSG_DONTWAIT);
  if (got < 0) {
    if (errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR) stage_ = Stage::over;
    return;
  }
  if (got == 0) {
    stage_ = Stage::over;
    return;
  }
  last_received_ = now;
  const std::string_view bytes(buffer.data(), static_cast<std::size_t>(got));
  if (stage_ == Stage::live) {
    frames_.push(bytes);
    take_frames(now);
  } else if (stage_ == Stage::draining) {
    drained_ += bytes.size();
    if (drained_ > kMostDrained) stage_ = Stage::over;
  } else {
    in_.append(bytes);
    take_request(now);
  }
}

void Connection::write_some(Timestamp now) {
  const Outgoing::Progress progress = out_.write_some(fd());
  if (progress == Outgoing::Progress::failed) {
    stage_ = Stage::over;
    return;
  }
  if (progress != Outgoing::Progress::finished) {
    if (out_.progressed() || !blocked_since_) blocked_since_ = now;
    return;
  }
  blocked_since_.reset();
  if (stage_ == Stage::answering) {
    ::shutdown(fd(), SHUT_WR);
    stage_ = Stage::draining;
    since_ = now;
  } else if (stage_ == Stage::live && closing_) {
    ::shutdown(fd(), SHUT_WR);
  }
}

void Connection::take_request(Timestamp now) {
  if (stage_ == Stage::head) {
    ReadHead head = read_http_head(in_, kMaxMessageBytes);
    if (head.refused) {
      count(context_.counters.refused);
      return answer(text_answer(head.refused->status, head.refused->why));
    }
    if (head.bytes == 0) return;
    count(context_.counters.requests);
    in_.erase(0, head.bytes);
    request_ = std::move(head.request);
    return begin(now);
  }
  if (stage_ == Stage::body && in_.size() >= request_.body_bytes) execute_body(now);
}

void Connection::begin(Timestamp now) {
  head_only_ = request_.method == "HEAD";
  Route found = route(request_, context_, {[this] { return peer_of(fd()); }, now});
  std::visit([&](auto& one) { do_route(one, now); }, found);
}

void Connection::do_route(Answer& answer_now, Timestamp /*now*/) { answer(answer_now); }

void Connection::do_route(Work& work, Timestamp now) {
  stage_ = Stage::waiting;
  since_ = now;
  const bool taken = context_.jobs.submit([inbox = context_.inbox, number = number_, work = std::move(work)] {
    inbox->post(number, [answer = guarded(work)](Connection* client) { client->answer(answer); });
  });
  if (!taken) answer(text_answer(503, "too many requests at once; try again"));
}

// No thread waits for the picture, so that many of these do not delay the live messages.
void Connection::do_route(TakeSnapshot& snapshot, Timestamp now) {
  std::atomic<std::uint64_t>& waiting = *context_.snapshots;
  if (waiting.load(std::memory_order_relaxed) >= kMaxSnapshotsWaiting)
    return answer_busy(503, "too many snapshots are pending; try again");
  stage_ = Stage::waiting;
  since_ = now;
  waiting.fetch_add(1, std::memory_order_relaxed);
  context_.gateway->ask_picture(
      snapshot.request, snapshot.format,
      [inbox = context_.inbox, number = number_, snapshots = context_.snapshots](Result<EncodedImage> picture) {
        snapshots->fetch_sub(1, std::memory_order_relaxed);
        inbox->post(number, [made = picture_answer(std::move(picture))](Connection* client) { client->answer(made); });
      });
}

// Bounded together with snapshots: each holds a connection, and the geometry of one moment is shared.
void Connection::do_route(TakeGeometry& take, Timestamp now) {
  std::atomic<std::uint64_t>& waiting = *context_.snapshots;
  if (waiting.load(std::memory_order_relaxed) >= kMaxSnapshotsWaiting)
    return answer_busy(503, "too many snapshots are pending; try again");
  stage_ = Stage::waiting;
  since_ = now;
  waiting.fetch_add(1, std::memory_order_relaxed);
  context_.gateway->ask_geometry(
      [inbox = context_.inbox, number = number_, known = std::move(take.known),
       snapshots = context_.snapshots](const Result<std::shared_ptr<const SceneGeometry>>& geometry) {
        snapshots->fetch_sub(1, std::memory_order_relaxed);
        inbox->post(number, [made = geometry_answer(geometry, known)](Connection* client) { client->answer(made); });
      });
}

void Connection::do_route(ExecuteBody& /*execute*/, Timestamp now) {
  stage_ = Stage::body;
  if (in_.size() >= request_.body_bytes) return execute_body(now);
  if (!request_.header_has("expect", "100-continue")) return;
  out_.push(chunk_of_constant("HTTP/1.1 100 Continue\r\n\r\n"));
  write_some(now);
}

void Connection::do_route(OpenWebSocket& open, Timestamp now) {
  const std::string peer = peer_of(fd());
  place_ = context_.places.take(peer, open.has_token);
  if (place_ == nullptr) {
    count(context_.counters.refused);
    return answer(text_answer(503, context_.gateway == nullptr
                                       ? "too many of these pages are open; close one of yours"
                                       : "too many pages of this gateway are open; close one of yours, or open the "
                                         "page by the address that this prints: cellmirror page"));
  }
  count(context_.counters.clients);
  // Pictures in the send buffer of the kernel get old: room for about two.
  const int bytes = 128 * 1024;
  ::setsockopt(fd(), SOL_SOCKET, SO_SNDBUF, &bytes, sizeof bytes);
  stage_ = Stage::live;
  out_.push(fmt::format(
      "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: "
      "Upgrade\r\nSec-WebSocket-Accept: {}\r\n{}\r\n",
      open.accept, open.subprotocol.empty() ? "" : fmt::format("Sec-WebSocket-Protocol: {}\r\n", open.subprotocol)));
  if (open.foxglove != nullptr) {
    foxglove_.emplace(context_, number_, peer, *open.foxglove, open.has_token);
    foxglove_->welcome(out_);
  } else {
    session_.emplace(context_, number_, peer);
    session_->welcome(out_);
  }
  write_some(now);
  if (!in_.empty() && !over()) {
    frames_.push(std::exchange(in_, {}));
    take_frames(now);
  }
}

void Connection::execute_body(Timestamp now) {
  const std::string text = in_.substr(0, request_.body_bytes);
  if (text.size() > kMaxCommandBytes || text.find_first_not_of(" \t\r\n") == std::string::npos ||
      text.find('\0') != std::string::npos) {
    count(context_.counters.refused);
    return answer(text_answer(400, "the body is not a SCRIPT command"));
  }
  if (!context_.posted_commands.allows(now)) return answer_busy(429, "too many commands; wait a second");
  stage_ = Stage::waiting;
  since_ = now;
  count(context_.counters.commands);
  context_.gateway->execute(
      text, {number_, peer_of(fd())}, [inbox = context_.inbox, number = number_](const CommandReply& reply) {
        inbox->post(number, [reply](Connection* client) { client->answer(json_answer(command_answer(reply))); });
      });
}

void Connection::take_frames(Timestamp now) {
  for (;;) {
    const auto message = frames_.next();
    // Frames count, not messages: a message may have any number of empty parts.
    if (!closing_ && !within_rate(frames_.take_count(), now)) {
      end(CloseCode::policy, "too much");
      break;
    }
    if (!message) break;
    if (closing_ && message->opcode != Opcode::close) continue;
    switch (message->opcode) {
      case Opcode::text:
        take_text(message->payload, now);
        break;
      case Opcode::binary:
        take_binary(message->payload, now);
        break;
      case Opcode::ping:
        out_.push(frame(Opcode::pong, message->payload));
        break;
      case Opcode::pong:
        break;
      case Opcode::close:
        if (closing_) {
          stage_ = Stage::over;
          return;
        }
        end(close_code_of(message->payload), {});  // section 5.5.1: its code is echoed
        break;
      default:
        break;
    }
  }
  if (frames_.error() && !closing_) {
    count(context_.counters.refused);
    end(*frames_.error(), "malformed or too long");
  }
  if (out_.pending() > most_pending()) return cut();
  if (!over() && !out_.empty()) write_some(now);
}

bool Connection::within_rate(std::size_t frames, Timestamp now) {
  return foxglove_ ? foxglove_->within_rate(frames, now) : session_->within_rate(frames, now);
}

void Connection::take_text(std::string_view text, Timestamp now) {
  const bool good = foxglove_ ? foxglove_->receive_text(text, now, out_) : session_->receive(text, now, out_);
  if (!good) end(CloseCode::policy, "wrong tokens");
}

void Connection::take_binary(std::string_view bytes, Timestamp now) {
  if (!foxglove_) return end(CloseCode::unsupported, "only text messages are supported");
  if (!foxglove_->receive_binary(bytes, now, out_)) end(CloseCode::policy, "wrong tokens");
}

// A client of the Foxglove protocol may have asked for a file, which is sent as one message.
std::size_t Connection::most_pending() const { return kMaxBacklogBytes + (foxglove_ ? kMaxAssetBytes : 0); }

void Connection::end(CloseCode code, std::string_view why) {
  if (!live() || closing_) return;
  closing_ = true;
  since_ = now_;
  out_.push(close_frame(code, why));
  write_some(now_);
}

void Connection::answer_busy(int status, std::string why) {
  count(context_.counters.refused);
  Answer busy = text_answer(status, std::move(why));
  busy.headers.emplace_back("Retry-After", "1");
  answer(busy);
}

void Connection::answer(const Answer& answer) {
  if (stage_ != Stage::head && stage_ != Stage::body && stage_ != Stage::waiting) return;
  stage_ = Stage::answering;
  since_ = now_;
  out_.push(head_of(answer, now_));
  if (!head_only_) out_.push(answer.body);
  write_some(now_);
}

void Connection::send_live(const Chunk& frame) {
  if (!live() || closing_ || !session_ || !out_.empty()) return;
  out_.push(frame);
  write_some(now_);
}

void Connection::send_picture(Timestamp now) {
  now_ = now;
  if (closing_) return;
  session_->send_picture(now, out_);
  if (!out_.empty()) write_some(now);
}

void Connection::command_answered(std::int64_t id, const CommandReply& reply) {
  if (!live() || !session_) return;
  session_->command_answered(id, reply, out_);
  if (closing_) return;
  if (out_.pending() > kMaxBacklogBytes) return cut();
  write_some(now_);
}

void Connection::picked(std::int64_t id, const Result<std::optional<PickedObject>>& object) {
  if (!live() || !session_) return;
  session_->picked(id, object, out_);
  if (!closing_) write_some(now_);
}

void Connection::send_topics() {
  with_foxglove([](FoxgloveSession& session, Outgoing& out) { session.send(out); });
}

void Connection::look_for_foxglove(Timestamp now) {
  now_ = now;
  with_foxglove([now](FoxgloveSession& session, Outgoing& out) { session.look(now, out); });
}

void Connection::with_foxglove(const std::function<void(FoxgloveSession&, Outgoing&)>& act) {
  if (!is_foxglove() || closing_) return;
  act(*foxglove_, out_);
  if (out_.pending() > most_pending()) return cut();
  if (!out_.empty()) write_some(now_);
}

}  // namespace cellmirror::web
