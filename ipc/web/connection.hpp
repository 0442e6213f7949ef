// One client connection, from its request to its end. Server's thread; never waits.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "ipc/web/foxglove_session.hpp"
#include "ipc/web/live_session.hpp"
#include "ipc/web/routes.hpp"
#include "rt_core/base/descriptor.hpp"

namespace cellmirror::web {

class Connection {
 public:
  enum class Stage : std::uint8_t {
    head,       // receives the head of the request
    body,       // receives the body
    waiting,    // for the answer from another thread
    answering,  // sends the answer
    draining,   // the answer is sent; further input is discarded: closing with unread input would reset the connection
    live,       // a WebSocket
    over,
  };

  Connection(Descriptor socket, std::uint64_t number, ServerContext& context, Timestamp now);
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection();

  [[nodiscard]] int fd() const { return socket_.get(); }
  [[nodiscard]] std::uint64_t number() const { return number_; }
  [[nodiscard]] Stage stage() const { return stage_; }
  [[nodiscard]] bool live() const { return stage_ == Stage::live; }
  [[nodiscard]] bool over() const { return stage_ == Stage::over; }
  [[nodiscard]] short wanted_events() const;
  // When check_time() is to be called at the latest.
  [[nodiscard]] Timestamp deadline() const;

  void handle_events(short events, Timestamp now);
  void check_time(Timestamp now);
  // Starts the closing handshake of a WebSocket.
  void end(CloseCode code, std::string_view why);

  // --- From the server.
  void answer(const Answer& answer);
  void send_live(const Chunk& frame);  // skipped while earlier output is pending
  [[nodiscard]] bool ready_for_picture() const { return live() && session_ && session_->ready_for_picture(out_); }
  void send_picture(Timestamp now);
  [[nodiscard]] bool is_page() const { return live() && session_.has_value(); }
  [[nodiscard]] bool is_foxglove() const { return live() && foxglove_.has_value(); }
  void look_for_foxglove(Timestamp now);

  // --- From other threads, through the inbox.
  void command_answered(std::int64_t id, const CommandReply& reply);
  void picked(std::int64_t id, const Result<std::optional<PickedObject>>& object);
  void send_topics();
  // Does nothing where it is no client of the Foxglove protocol, or is being closed.
  void with_foxglove(const std::function<void(FoxgloveSession&, Outgoing&)>& act);

 private:
  void read_some(Timestamp now);
  void write_some(Timestamp now);
  void take_request(Timestamp now);
  void begin(Timestamp now);
  void do_route(Answer& answer_now, Timestamp now);
  void do_route(Work& work, Timestamp now);
  void do_route(TakeSnapshot& snapshot, Timestamp now);
  void do_route(TakeGeometry& take, Timestamp now);
  void do_route(ExecuteBody& execute, Timestamp now);
  void do_route(OpenWebSocket& open, Timestamp now);
  void execute_body(Timestamp now);
  void take_frames(Timestamp now);
  [[nodiscard]] bool within_rate(std::size_t frames, Timestamp now);
  void take_text(std::string_view text, Timestamp now);
  void take_binary(std::string_view bytes, Timestamp now);
  [[nodiscard]] std::size_t most_pending() const;
  void cut();
  // With the header Retry-After.
  void answer_busy(int status, std::string why);
  [[nodiscard]] const Patience& patience() const { return context_.options.patience; }

  Descriptor socket_;
  std::uint64_t number_;
  ServerContext& context_;
  Stage stage_ = Stage::head;
  std::string in_;
  HttpRequest request_;
  bool head_only_ = false;
  Outgoing out_;
  std::optional<LiveSession> session_;       // of a page
  std::optional<FoxgloveSession> foxglove_;  // of a client of the Foxglove protocol
  std::shared_ptr<void> place_;              // of a WebSocket
  FrameReader frames_{kMaxMessageBytes};
  bool closing_ = false;     // of a WebSocket: a close frame was sent
  std::size_t drained_ = 0;  // bytes
  Timestamp since_;          // of the stage
  Timestamp last_received_;
  std::optional<Timestamp> blocked_since_;  // the socket accepts no more output
  Timestamp last_ping_;
  Timestamp now_;  // of the current call
};

}  // namespace cellmirror::web
