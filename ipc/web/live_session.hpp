// One client of /live: what it asked for, and what it gets. Belongs to the server's thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "ipc/web/client_message.hpp"
#include "ipc/web/flow.hpp"
#include "ipc/web/outgoing.hpp"
#include "ipc/web/server_context.hpp"
#include "ipc/web/websocket.hpp"

namespace cellmirror::web {

class LiveSession {
 public:
  // `connection`: its number, for what comes back from other threads.
  LiveSession(ServerContext& context, std::uint64_t connection) : context_(context), connection_(connection) {}

  void welcome(Outgoing& out) const;
  // Counts frames: messages, their parts, pings and pongs. False: there were too many; the connection is to be closed.
  [[nodiscard]] bool may_say_more(std::size_t frames, Timestamp now) { return frames_.allows(frames, now); }
  // False: the client is to be cut.
  [[nodiscard]] bool receive(std::string_view text, Timestamp now, Outgoing& out);
  void command_answered(std::int64_t id, const CommandReply& reply, Outgoing& out);
  void picked(std::int64_t id, const Result<std::optional<PickedObject>>& object, Outgoing& out);

  // Whether the client would be sent a picture now if there were one.
  [[nodiscard]] bool ready_for_picture(const Outgoing& out) const;
  void send_picture(Timestamp now, Outgoing& out);

 private:
  // Once for each wish, since the client sees only that no picture comes.
  void tell_problem(Outgoing& out);
  // Pictures that would have come while the client was not ready for them.
  void count_left_out(Timestamp now);
  void follow(const HelloMessage& message, Outgoing& out);
  void follow(const PictureMessage& message, Outgoing& out);
  void follow(const NoPictureMessage& message, Outgoing& out);
  void follow(const ShownMessage& message, Outgoing& out);
  void follow(const CommandMessage& message, Outgoing& out);
  void follow(const PickMessage& message, Outgoing& out);

  ServerContext& context_;
  std::uint64_t connection_;
  Timestamp now_;  // of the message that is followed
  bool may_command_ = false;
  int wrong_tokens_ = 0;
  RateLimit frames_{kFramesPerSecond};
  RateLimit commands_{kCommandsPerSecond};
  std::size_t commands_waiting_ = 0;
  std::size_t picks_waiting_ = 0;
  std::unique_ptr<PictureStream> stream_;
  PictureRequest wish_;
  PictureCredit credit_;
  std::uint64_t newest_ = 0;  // sequence of the stream
  std::string told_;          // problem of the stream
  std::optional<Timestamp> no_credit_since_;

  static constexpr double kFramesPerSecond = 500;  // no person and no page sends more
};

}  // namespace cellmirror::web
