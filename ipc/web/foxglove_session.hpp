// The Foxglove protocol of one WebSocket: subscriptions and their messages, SCRIPT commands as a service, parameters
// and files. Server's thread. What clients send and get is in ipc/foxglove.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/foxglove/client_message.hpp"
#include "ipc/web/flow.hpp"
#include "ipc/web/live_data.hpp"
#include "ipc/web/outgoing.hpp"
#include "ipc/web/server_context.hpp"

namespace cellmirror::web {

class FoxgloveSession {
 public:
  static constexpr Nanoseconds kLookPeriod{100'000'000};  // how often look() is called

  // `connection`: its number, for replies from other threads. `peer`: as of peer_of(). `has_token`: it came with the
  // opening. `data` outlives the session.
  FoxgloveSession(ServerContext& context, std::uint64_t connection, std::string peer, LiveData& data, bool has_token);

  void welcome(Outgoing& out);
  // Counts frames, as LiveSession does.
  [[nodiscard]] bool within_rate(std::size_t frames, Timestamp now) { return frames_.allows(frames, now); }
  // False: the connection is to be closed.
  [[nodiscard]] bool receive_text(std::string_view text, Timestamp now, Outgoing& out);
  [[nodiscard]] bool receive_binary(std::string_view bytes, Timestamp now, Outgoing& out);
  // Whether send() has something to send or to begin.
  [[nodiscard]] bool waiting() const;
  void send(Outgoing& out);
  // What changes by itself: the time, channels, parameters, messages that were left out.
  void look(Timestamp now, Outgoing& out);

 private:
  bool receive(const std::expected<foxglove::ClientMessage, std::string>& message, Timestamp now, Outgoing& out);
  void handle(const foxglove::Subscribe& message, Outgoing& out);
  void handle(const foxglove::Unsubscribe& message, Outgoing& out);
  void handle(const foxglove::GetParameters& message, Outgoing& out);
  void handle(const foxglove::SetParameters& message, Outgoing& out);
  void handle(const foxglove::SubscribeParameters& message, Outgoing& out);
  void handle(const foxglove::UnsubscribeParameters& message, Outgoing& out);
  void handle(const foxglove::FetchAsset& message, Outgoing& out);
  void handle(const foxglove::CallService& message, Outgoing& out);
  void handle(const foxglove::PlaybackControl& message, Outgoing& out);
  // What has changed in how a recording is played, other than by this client's request.
  void report_playback(Outgoing& out);
  void send_playback(const PlaybackState& state, std::string_view request, Outgoing& out);
  // Empty: the request may be executed.
  [[nodiscard]] std::string why_not_executed(const foxglove::CommandRequest& request);
  void report_problem(std::string_view text, Outgoing& out, std::string_view id = {});
  // Reads all parameters in another thread. False: too much is under way.
  bool read_parameters(std::function<void(FoxgloveSession&, const std::vector<foxglove::Parameter>&, Outgoing&)> then);
  void send_parameters(const std::vector<foxglove::Parameter>& all, const std::vector<std::string>& names,
                       const std::optional<std::string>& request, Outgoing& out);
  void send_changed_parameters(const std::vector<foxglove::Parameter>& all, Outgoing& out);
  void begin_asset(Outgoing& out);
  void send_asset(std::uint32_t request, Result<std::string> content, Outgoing& out);
  void report_dropped(Outgoing& out);

  ServerContext& context_;
  std::uint64_t connection_;
  std::string peer_;
  LiveData& data_;
  bool may_command_;
  std::uint64_t known_playback_ = 0;  // PlaybackState::changes, as sent
  std::uint64_t known_seeks_ = 0;     // likewise
  std::unique_ptr<foxglove::TopicFeed::Subscriber> topics_;
  Timestamp now_;  // of the message that is handled
  int wrong_tokens_ = 0;
  RateLimit frames_;
  RateLimit commands_;
  std::size_t commands_waiting_ = 0;
  std::size_t reads_waiting_ = 0;  // of parameters
  std::deque<foxglove::FetchAsset> assets_;
  bool asset_under_way_ = false;  // is being read, or was not sent to its end
  bool asset_read_ = false;       // of that one: it was read
  bool all_parameters_ = false;   // are subscribed to
  std::set<std::string, std::less<>> parameters_;
  std::map<std::string, foxglove::ParameterValue> known_parameters_;  // of these, as sent
  bool looking_at_parameters_ = false;
  Timestamp last_parameters_;
  Timestamp last_dropped_;
  std::map<std::string, std::uint64_t> told_dropped_;
};

}  // namespace cellmirror::web
