// One client's socket, from its request to its end. Belongs to the server's thread; never waits.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "ipc/runtime/descriptor.hpp"
#include "ipc/web/live_session.hpp"
#include "ipc/web/routes.hpp"

namespace cellmirror::web {

class Connection {
 public:
  enum class Stage : std::uint8_t {
    head,       // its request comes
    body,       // the rest of it
    waiting,    // for its answer from another thread
    answering,  // its answer goes
    draining,   // the answer is gone; what still comes is thrown away, so that the answer is not lost to a reset
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
  // When check_time() has something to do, unless anything happens before.
  [[nodiscard]] Timestamp deadline() const;

  void go_on(short events, Timestamp now);
  void check_time(Timestamp now);
  // Says goodbye, as far as that goes without waiting.
  void end(CloseCode code, std::string_view why);

  // --- From the server.
  void answer(const Answer& answer);
  void show_live(const Chunk& frame);  // passed over where the client has not read what it got before
  [[nodiscard]] bool ready_for_picture() const { return live() && session_->ready_for_picture(out_); }
  void send_picture(Timestamp now);

  // --- From other threads, through the inbox.
  void command_answered(std::int64_t id, const CommandReply& reply);
  void picked(std::int64_t id, const Result<std::optional<PickedObject>>& object);

 private:
  void read_some(Timestamp now);
  void write_some(Timestamp now);
  void take_request(Timestamp now);
  void begin(Timestamp now);
  void do_route(Answer& answer_now, Timestamp now);
  void do_route(Work& work, Timestamp now);
  void do_route(TakeSnapshot& snapshot, Timestamp now);
  void do_route(ExecuteBody& execute, Timestamp now);
  void do_route(OpenWebSocket& open, Timestamp now);
  void execute_body(Timestamp now);
  void take_frames(Timestamp now);
  void cut();
  // With the header that says when to ask again.
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
  std::optional<LiveSession> session_;
  std::shared_ptr<void> place_;  // of a WebSocket
  FrameReader frames_{kMaxMessageBytes};
  bool closing_ = false;     // of a WebSocket: a close frame is on its way
  std::size_t drained_ = 0;  // bytes
  Timestamp since_;          // of the stage
  Timestamp last_received_;
  std::optional<Timestamp> blocked_since_;  // the socket takes nothing
  Timestamp last_ping_;
  Timestamp now_;  // of the call that is running
};

}  // namespace cellmirror::web
