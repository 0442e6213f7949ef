#include "ipc/web/live_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "ipc/web/connection.hpp"
#include "ipc/web/server_message.hpp"

namespace cellmirror::web {

namespace {

constexpr int kMostWrongTokens = 3;
constexpr std::size_t kMostPicksWaiting = 4;

void send_text(Outgoing& out, std::string_view text) { out.push(frame(Opcode::text, text)); }

}  // namespace

void LiveSession::welcome(Outgoing& out) const {
  const ServerOptions& options = context_.options;
  send_text(out, welcome_message(
                     {options.version, options.cell, options.instance, options.run, may_command_, options.read_only}));
}

bool LiveSession::receive(std::string_view text, Timestamp now, Outgoing& out) {
  now_ = now;
  const auto message = read_client_message(text);
  if (!message) {
    count(context_.counters.refused);
    send_text(out, refused_message(message.error().id, message.error().why));
    return true;
  }
  if (context_.gateway == nullptr && !std::holds_alternative<HelloMessage>(*message)) {
    count(context_.counters.refused);
    send_text(out, refused_message(0, "this page only shows"));
    return true;
  }
  std::visit([&](const auto& one) { handle(one, out); }, *message);
  return wrong_tokens_ < kMostWrongTokens;
}

void LiveSession::handle(const HelloMessage& message, Outgoing& out) {
  using enum TokenTries::Verdict;
  const TokenTries::Check checked = check_token(context_, message.token, peer_, now_);
  may_command_ = checked.right() && !context_.options.read_only;
  if (checked.verdict == wrong || checked.verdict == unread) {
    ++wrong_tokens_;
    count(context_.counters.refused);
    send_text(out, refused_message(0, checked.verdict == unread
                                          ? too_many_wrong_tokens_text(checked.wait_s)
                                          : std::string("wrong token: it belongs to another gateway or an older run; "
                                                        "cellmirror page prints the address with the current one")));
  }
  welcome(out);
}

void LiveSession::handle(const PictureMessage& message, Outgoing& out) {
  request_ = message.request;
  reported_problem_.clear();
  if (stream_) {
    stream_->change(request_);
    return;
  }
  auto stream = context_.gateway->open_pictures(request_);
  if (!stream) {
    send_text(out, refused_message(0, stream.error().text()));
    return;
  }
  stream_ = std::move(*stream);
  newest_ = 0;
}

void LiveSession::handle(const NoPictureMessage& /*message*/, Outgoing& /*out*/) {
  count_left_out(now_);
  stream_.reset();
}

void LiveSession::handle(const ShownMessage& message, Outgoing& /*out*/) {
  credit_.shown(message.sequence);
  if (credit_.may_send()) count_left_out(now_);
}

void LiveSession::handle(const SceneMessage& /*message*/, Outgoing& out) {
  if (scene_) return;
  auto scene = context_.gateway->open_scene();
  if (!scene) return send_text(out, refused_message(0, scene.error().text()));
  scene_ = std::move(*scene);
  newest_poses_ = 0;
  newest_marks_ = 0;
  newest_tissue_ = 0;
}

void LiveSession::handle(const NoSceneMessage& /*message*/, Outgoing& /*out*/) { scene_.reset(); }

void LiveSession::handle(const PosedMessage& message, Outgoing& /*out*/) { pose_credit_.shown(message.sequence); }

void LiveSession::count_left_out(Timestamp now) {
  if (!no_credit_since_) return;
  const double periods = seconds(now - *no_credit_since_) * request_.rate_hz;
  count(context_.counters.pictures_left_out, static_cast<std::uint64_t>(std::max(0.0, periods)));
  no_credit_since_.reset();
}

void LiveSession::handle(const CommandMessage& message, Outgoing& out) {
  const auto refuse = [&](std::string_view why) {
    count(context_.counters.refused);
    send_text(out, reply_message(message.id, {false, std::string(why)}));
  };
  if (context_.options.read_only) return refuse("commands are disabled: the gateway was started read-only");
  if (!may_command_) {
    return refuse("commands need the token: open the page by the address that this prints: cellmirror page");
  }
  if (!commands_.allows(now_)) return refuse("too many commands; wait a second");
  if (commands_waiting_ >= kMaxCommandsWaiting)
    return refuse(fmt::format("{} commands are waiting for their acknowledgement", commands_waiting_));
  ++commands_waiting_;
  count(context_.counters.commands);
  context_.gateway->execute(
      message.text, {connection_, peer_},
      [inbox = context_.inbox, connection = connection_, id = message.id](const CommandReply& reply) {
        inbox->post(connection, [id, reply](Connection* client) { client->command_answered(id, reply); });
      });
}

void LiveSession::handle(const PickMessage& message, Outgoing& out) {
  if (!stream_) return send_text(out, refused_message(message.id, "there is no picture to pick from"));
  if (message.x >= request_.width || message.y >= request_.height)
    return send_text(out, refused_message(message.id, "that pixel is outside the picture"));
  if (picks_waiting_ >= kMostPicksWaiting)
    return send_text(out, refused_message(message.id, "too many requests at once; try again"));
  ++picks_waiting_;
  context_.gateway->ask_pick(
      request_, message.x, message.y,
      [inbox = context_.inbox, connection = connection_, id = message.id](Result<std::optional<PickedObject>> object) {
        inbox->post(connection, [id, object = std::move(object)](Connection* client) { client->picked(id, object); });
      });
}

void LiveSession::handle(const PlaybackMessage& message, Outgoing& out) {
  PlaybackPort* const playback = context_.gateway->playback();
  if (playback == nullptr) return send_text(out, refused_message(0, "this gateway plays no recording"));
  if (context_.options.read_only) return send_text(out, refused_message(0, "this gateway was started read-only"));
  PlaybackRequest request{.play = message.play, .speed = message.speed, .seek_ns = {}};
  if (message.seek_s && std::isfinite(*message.seek_s))
    request.seek_ns = playback_time_ns(playback->state(), *message.seek_s);
  if (const auto done = playback->apply(request); !done) send_text(out, refused_message(0, done.error().text()));
}

void LiveSession::command_answered(std::int64_t id, const CommandReply& reply, Outgoing& out) {
  --commands_waiting_;
  send_text(out, reply_message(id, reply));
}

void LiveSession::picked(std::int64_t id, const Result<std::optional<PickedObject>>& object, Outgoing& out) {
  --picks_waiting_;
  send_text(out, object ? picked_message(id, *object) : refused_message(id, object.error().text()));
}

void LiveSession::report_problem(Outgoing& out) {
  std::string problem = stream_->problem();
  if (problem.empty() || problem == reported_problem_) return;
  reported_problem_ = std::move(problem);
  send_text(out, refused_message(0, reported_problem_));
}

bool LiveSession::ready_for_picture(const Outgoing& out) const {
  if (!out.empty()) return false;
  return (stream_ && credit_.may_send()) || (scene_ && pose_credit_.may_send());
}

void LiveSession::send_picture(Timestamp now, Outgoing& out) {
  if (scene_ && pose_credit_.may_send()) send_poses(out);
  if (stream_ && credit_.may_send() && out.empty()) send_picture_of_stream(now, out);
}

void LiveSession::send_poses(Outgoing& out) {
  const std::shared_ptr<const SceneUpdate> update = scene_->newest(newest_poses_);
  if (!update) return;
  newest_poses_ = update->sequence;
  if (update->marks && update->marks_sequence != newest_marks_) {
    newest_marks_ = update->marks_sequence;
    out.push(frame_header(Opcode::text, update->marks->size()));
    out.push(Chunk{update->marks, *update->marks});
  }
  out.push(frame_header(Opcode::binary, kPosesHeaderBytes + update->poses.size()) +
           poses_header(pose_credit_.next(), *update, context_.gateway->cell_clock().now()));
  out.push(Chunk{update, update->poses});
  // Behind the poses whose number is acknowledged: none of it is sent faster than the client draws.
  const auto push_whole = [&](const std::shared_ptr<const std::string>& message) {
    out.push(frame_header(Opcode::binary, message->size()));
    out.push(Chunk{message, *message});
  };
  if (update->tissue_shape && update->tissue_number != newest_tissue_) {
    newest_tissue_ = update->tissue_number;
    push_whole(update->tissue_shape);
  }
  if (update->tissue_motion) push_whole(update->tissue_motion);
}

void LiveSession::send_picture_of_stream(Timestamp now, Outgoing& out) {
  const std::shared_ptr<const EncodedImage> picture = stream_->newest(newest_);
  if (!picture) return report_problem(out);
  newest_ = picture->sequence;
  reported_problem_.clear();
  const std::string_view bytes(reinterpret_cast<const char*>(picture->bytes.data()), picture->bytes.size());
  out.push(frame_header(Opcode::binary, kPictureHeaderBytes + bytes.size()) +
           picture_header(credit_.next(), *picture, context_.gateway->cell_clock().now()));
  out.push(Chunk{picture, bytes});
  count(context_.counters.pictures);
  if (!credit_.may_send()) no_credit_since_ = now;
}

}  // namespace cellmirror::web
