// The protocol of one WebSocket: its requests, its pictures, its commands. Server's thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "ipc/web/client_message.hpp"
#include "ipc/web/flow.hpp"
#include "ipc/web/outgoing.hpp"
#include "ipc/web/server_context.hpp"
#include "ipc/web/websocket.hpp"

namespace cellmirror::web {

class LiveSession {
 public:
  // `connection`: its number, for replies from other threads. `peer`: as of peer_of().
  LiveSession(ServerContext& context, std::uint64_t connection, std::string peer)
      : context_(context), connection_(connection), peer_(std::move(peer)) {}

  void welcome(Outgoing& out) const;
  // Counts frames: messages, their parts, pings and pongs. False: too many; the connection is to be closed.
  [[nodiscard]] bool within_rate(std::size_t frames, Timestamp now) { return frames_.allows(frames, now); }
  // False: the connection is to be closed. Where there is no gateway all but a greeting is refused.
  [[nodiscard]] bool receive(std::string_view text, Timestamp now, Outgoing& out);
  void command_answered(std::int64_t id, const CommandReply& reply, Outgoing& out);
  void picked(std::int64_t id, const Result<std::optional<PickedObject>>& object, Outgoing& out);

  // Whether a new picture, or new poses, would be sent now.
  [[nodiscard]] bool ready_for_picture(const Outgoing& out) const;
  void send_picture(Timestamp now, Outgoing& out);

 private:
  void send_picture_of_stream(Timestamp now, Outgoing& out);
  void send_poses(Outgoing& out);
  // Once for each request: why no picture comes.
  void report_problem(Outgoing& out);
  // Pictures that were skipped while the client had no credit.
  void count_left_out(Timestamp now);
  void handle(const HelloMessage& message, Outgoing& out);
  void handle(const PictureMessage& message, Outgoing& out);
  void handle(const NoPictureMessage& message, Outgoing& out);
  void handle(const ShownMessage& message, Outgoing& out);
  void handle(const SceneMessage& message, Outgoing& out);
  void handle(const NoSceneMessage& message, Outgoing& out);
  void handle(const PosedMessage& message, Outgoing& out);
  void handle(const CommandMessage& message, Outgoing& out);
  void handle(const PickMessage& message, Outgoing& out);
  void handle(const PlaybackMessage& message, Outgoing& out);

  ServerContext& context_;
  std::uint64_t connection_;
  std::string peer_;
  Timestamp now_;  // of the message that is handled
  bool may_command_ = false;
  int wrong_tokens_ = 0;
  RateLimit frames_{kFramesPerSecond};
  RateLimit commands_{kCommandsPerSecond};
  std::size_t commands_waiting_ = 0;
  std::size_t picks_waiting_ = 0;
  std::unique_ptr<PictureStream> stream_;
  PictureRequest request_;
  PictureCredit credit_;
  std::uint64_t newest_ = 0;      // sequence of the stream
  std::string reported_problem_;  // of the stream
  std::optional<Timestamp> no_credit_since_;
  std::unique_ptr<SceneStream> scene_;
  PictureCredit pose_credit_;
  std::uint64_t newest_poses_ = 0;  // sequence of the stream
  std::uint64_t newest_marks_ = 0;
  std::uint32_t newest_tissue_ = 0;  // number of the shape

  static constexpr double kFramesPerSecond = 500;  // more than any page sends
};

}  // namespace cellmirror::web
