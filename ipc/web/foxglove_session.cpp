#include "ipc/web/foxglove_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <limits>
#include <utility>
#include <variant>

#include "ipc/foxglove/server_message.hpp"
#include "ipc/web/client_message.hpp"
#include "ipc/web/connection.hpp"
#include "ipc/web/server_message.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::web {

namespace {

constexpr int kMostWrongTokens = 3;
constexpr double kFramesPerSecond = 500;
constexpr std::size_t kMostAssetsWaiting = 256;
constexpr std::size_t kMostReadsWaiting = 4;  // of parameters
constexpr std::size_t kMostParameters = 512;  // subscribed to by name
// Topics are sent as long as less is pending than this; small, so that newer messages of one topic do not wait behind
// older ones of another.
constexpr std::size_t kMostAhead = 32 * 1024;
constexpr Nanoseconds kParameterPeriod{1'000'000'000};
constexpr Nanoseconds kDroppedPeriod{1'000'000'000};
constexpr std::uint32_t kCommandService = 1;
constexpr std::string_view kDroppedId = "left-out";

constexpr const char* kRequestSchema = R"({"type":"object","title":"a SCRIPT command","properties":{
"command":{"type":"string"},"token":{"type":"string"}},"required":["command"]})";
constexpr const char* kResponseSchema = R"({"type":"object","title":"its acknowledgement","properties":{
"done":{"type":"boolean"},"text":{"type":"string"}}})";

// No request may end the gateway.
Result<std::string> asset_of(LiveData& data, std::string_view uri) {
  try {
    return data.asset(uri);
  } catch (const std::exception& error) {
    return fail(std::string("unexpected failure: ") + error.what());
  }
}

std::vector<foxglove::Parameter> parameters_of(LiveData& data) {
  try {
    return data.parameters();
  } catch (const std::exception& error) {
    log_error("web.parameters", "the parameters could not be read: {}", error.what());
    return {};
  }
}

void send_text(Outgoing& out, std::string_view text) { out.push(frame(Opcode::text, text)); }
void send_binary(Outgoing& out, std::string_view bytes) { out.push(frame(Opcode::binary, bytes)); }

}  // namespace

FoxgloveSession::FoxgloveSession(ServerContext& context, std::uint64_t connection, std::string peer, LiveData& data,
                                 bool has_token)
    : context_(context),
      connection_(connection),
      peer_(std::move(peer)),
      data_(data),
      may_command_(has_token && !context.options.read_only),
      topics_(data.feed().join([inbox = context.inbox, connection] {
        inbox->post(connection, [](Connection* client) { client->send_topics(); });
      })),
      frames_(kFramesPerSecond),
      commands_(kCommandsPerSecond) {}

void FoxgloveSession::welcome(Outgoing& out) {
  const ServerOptions& options = context_.options;
  foxglove::ServerInfo info{"cellmirror " + options.cell,
                            {{"version", options.version}, {"cell", options.cell}, {"instance", options.instance}},
                            options.run};
  PlaybackPort* const playback = context_.gateway->playback();
  if (playback != nullptr) {
    const PlaybackState state = playback->state();
    info.played = {static_cast<std::uint64_t>(state.from_ns), static_cast<std::uint64_t>(state.to_ns)};
  }
  send_text(out, foxglove::server_info_message(info));
  send_text(out, foxglove::advertise_message(topics_->new_channels()));
  if (playback != nullptr) send_playback(playback->state(), {}, out);
  if (options.read_only) return;
  const std::array<foxglove::Service, 1> services = {
      {{kCommandService, "/cellmirror/command", "cellmirror.Command", kRequestSchema, kResponseSchema}}};
  send_text(out, foxglove::advertise_services_message(services));
}

bool FoxgloveSession::receive_text(std::string_view text, Timestamp now, Outgoing& out) {
  return receive(foxglove::read_text_message(text), now, out);
}

bool FoxgloveSession::receive_binary(std::string_view bytes, Timestamp now, Outgoing& out) {
  return receive(foxglove::read_binary_message(bytes), now, out);
}

bool FoxgloveSession::receive(const std::expected<foxglove::ClientMessage, std::string>& message, Timestamp now,
                              Outgoing& out) {
  now_ = now;
  if (!message) {
    count(context_.counters.refused);
    report_problem(message.error(), out);
    return true;
  }
  std::visit([&](const auto& one) { handle(one, out); }, *message);
  return wrong_tokens_ < kMostWrongTokens;
}

void FoxgloveSession::report_problem(std::string_view text, Outgoing& out, std::string_view id) {
  send_text(out, foxglove::status_message(foxglove::StatusLevel::error, text, id));
}

void FoxgloveSession::handle(const foxglove::Subscribe& message, Outgoing& out) {
  for (const foxglove::Subscription& one : message.subscriptions) {
    if (const auto done = topics_->subscribe(one); !done) report_problem(done.error(), out);
  }
}

void FoxgloveSession::handle(const foxglove::Unsubscribe& message, Outgoing& out) {
  for (const std::uint32_t one : message.subscriptions) {
    if (!topics_->unsubscribe(one)) report_problem(fmt::format("there is no subscription {}", one), out);
  }
}

// --- Parameters.

bool FoxgloveSession::read_parameters(
    std::function<void(FoxgloveSession&, const std::vector<foxglove::Parameter>&, Outgoing&)> then) {
  if (reads_waiting_ >= kMostReadsWaiting) return false;
  const bool taken = context_.jobs.submit(
      [&data = data_, inbox = context_.inbox, connection = connection_, then = std::move(then)]() mutable {
        inbox->post(connection, [all = parameters_of(data), then = std::move(then)](Connection* client) {
          client->with_foxglove([&](FoxgloveSession& session, Outgoing& out) {
            --session.reads_waiting_;
            then(session, all, out);
          });
        });
      });
  if (taken) ++reads_waiting_;
  return taken;
}

void FoxgloveSession::send_parameters(const std::vector<foxglove::Parameter>& all,
                                      const std::vector<std::string>& names, const std::optional<std::string>& request,
                                      Outgoing& out) {
  std::vector<foxglove::Parameter> wanted;
  for (const foxglove::Parameter& one : all) {
    if (names.empty() || std::ranges::find(names, one.name) != names.end()) wanted.push_back(one);
  }
  send_text(out, foxglove::parameters_message(wanted, request));
}

void FoxgloveSession::handle(const foxglove::GetParameters& message, Outgoing& out) {
  const bool taken = read_parameters([message](FoxgloveSession& session, const auto& all, Outgoing& to) {
    session.send_parameters(all, message.names, message.request, to);
  });
  if (!taken) report_problem("too many requests at once; try again", out);
}

void FoxgloveSession::handle(const foxglove::SetParameters& message, Outgoing& out) {
  if (context_.options.read_only) return report_problem("parameters: this gateway was started read-only", out);
  if (!may_command_) {
    count(context_.counters.refused);
    return report_problem(
        "parameters are set only by clients that have shown the token: call the service /cellmirror/command with it, "
        "or "
        "send it in the header Authorization (docs/recording.md)",
        out);
  }
  std::vector<std::string> names;
  for (const foxglove::Parameter& one : message.parameters) {
    if (!commands_.allows(now_)) {
      report_problem("too many parameters were set at once; wait a second", out);
      break;
    }
    names.push_back(one.name);
    count(context_.counters.commands);
    data_.set_parameter(one, {connection_, peer_},
                        [inbox = context_.inbox, connection = connection_, name = one.name](const Result<void>& done) {
                          if (done) return;
                          inbox->post(connection, [name, why = done.error().text()](Connection* client) {
                            client->with_foxglove([&](FoxgloveSession& session, Outgoing& to) {
                              session.report_problem(fmt::format("{}: {}", printable(name), why), to);
                            });
                          });
                        });
  }
  if (!message.request) return;
  // What was set by a SCRIPT command shows in the next update.
  handle(foxglove::GetParameters{std::move(names), message.request}, out);
}

void FoxgloveSession::handle(const foxglove::SubscribeParameters& message, Outgoing& out) {
  if (message.names.empty()) all_parameters_ = true;
  for (const std::string& name : message.names) {
    if (parameters_.size() >= kMostParameters) return report_problem("too many parameters are subscribed to", out);
    parameters_.insert(name);
  }
  last_parameters_ = {};
}

void FoxgloveSession::handle(const foxglove::UnsubscribeParameters& message, Outgoing& /*out*/) {
  if (message.names.empty()) {
    all_parameters_ = false;
    parameters_.clear();
    known_parameters_.clear();
  }
  for (const std::string& name : message.names) {
    parameters_.erase(name);
    known_parameters_.erase(name);
  }
}

void FoxgloveSession::send_changed_parameters(const std::vector<foxglove::Parameter>& all, Outgoing& out) {
  looking_at_parameters_ = false;
  std::vector<foxglove::Parameter> changed;
  for (const foxglove::Parameter& one : all) {
    if (!all_parameters_ && !parameters_.contains(one.name)) continue;
    const auto known = known_parameters_.find(one.name);
    if (known != known_parameters_.end() && known->second == one.value) continue;
    known_parameters_[one.name] = one.value;
    changed.push_back(one);
  }
  if (!changed.empty()) send_text(out, foxglove::parameters_message(changed, std::nullopt));
}

// --- Files.

void FoxgloveSession::handle(const foxglove::FetchAsset& message, Outgoing& out) {
  if (assets_.size() >= kMostAssetsWaiting)
    return send_binary(out, foxglove::asset_failed_message(message.request, "too many files are asked for at once"));
  assets_.push_back(message);
  begin_asset(out);
}

// One at a time, so that a client cannot make the server keep many files.
void FoxgloveSession::begin_asset(Outgoing& out) {
  if (asset_under_way_ || assets_.empty()) return;
  const foxglove::FetchAsset next = std::move(assets_.front());
  assets_.pop_front();
  asset_under_way_ = true;
  asset_read_ = false;
  const bool taken = context_.jobs.submit([&data = data_, inbox = context_.inbox, connection = connection_, next] {
    inbox->post(connection, [request = next.request, content = asset_of(data, next.uri)](Connection* client) mutable {
      client->with_foxglove(
          [&](FoxgloveSession& session, Outgoing& to) { session.send_asset(request, std::move(content), to); });
    });
  });
  if (!taken) send_asset(next.request, fail("too many requests at once; try again"), out);
}

void FoxgloveSession::send_asset(std::uint32_t request, Result<std::string> content, Outgoing& out) {
  asset_read_ = true;
  if (!content) {
    count(context_.counters.refused);
    return send_binary(out, foxglove::asset_failed_message(request, content.error().text()));
  }
  const std::string head = foxglove::asset_head(request);
  out.push(frame_header(Opcode::binary, head.size() + content->size()) + head);
  out.push(chunk_of(*std::move(content)));
}

// --- SCRIPT commands.

std::string FoxgloveSession::why_not_executed(const foxglove::CommandRequest& request) {
  if (context_.options.read_only) return "this gateway was started read-only";
  if (!request.token.empty()) {
    const TokenTries::Check checked = check_token(context_, request.token, peer_, now_);
    may_command_ = checked.right();
    if (!may_command_) {
      ++wrong_tokens_;
      if (checked.verdict == TokenTries::Verdict::unread) return too_many_wrong_tokens_text(checked.wait_s);
      return "wrong token: it belongs to another gateway or an older run; cellmirror page --json prints the current "
             "one";
    }
  }
  if (!may_command_) return "commands need the field token of the request; cellmirror page --json prints it";
  if (!commands_.allows(now_)) return "too many commands; wait a second";
  if (commands_waiting_ >= kMaxCommandsWaiting) return "too many commands wait for their acknowledgement";
  return {};
}

void FoxgloveSession::handle(const foxglove::CallService& message, Outgoing& out) {
  const auto refuse = [&](std::string_view why) {
    count(context_.counters.refused);
    send_text(out, foxglove::service_failed_message(message.service, message.call, why));
  };
  if (message.service != kCommandService) return refuse("there is no such service");
  if (message.encoding != "json") return refuse("requests of services are JSON (encoding json)");
  const auto request = foxglove::read_command_request(message.payload, kMaxCommandBytes);
  if (!request) return refuse(request.error());
  if (const std::string why = why_not_executed(*request); !why.empty()) return refuse(why);
  ++commands_waiting_;
  count(context_.counters.commands);
  foxglove::CallService call{message.service, message.call, message.encoding, {}};
  context_.gateway->execute(
      request->command, {connection_, peer_},
      [inbox = context_.inbox, connection = connection_, call = std::move(call)](const CommandReply& reply) {
        inbox->post(connection, [call, reply](Connection* client) {
          client->with_foxglove([&](FoxgloveSession& session, Outgoing& to) {
            --session.commands_waiting_;
            send_binary(to, foxglove::service_response(call, command_answer(reply)));
          });
        });
      });
}

// --- The playing of a recording.

void FoxgloveSession::send_playback(const PlaybackState& state, std::string_view request, Outgoing& out) {
  const auto word_of = [](PlaybackStatus status) {
    switch (status) {
      case PlaybackStatus::playing:
        return foxglove::PlaybackWord::playing;
      case PlaybackStatus::paused:
        return foxglove::PlaybackWord::paused;
      case PlaybackStatus::seeking:
        return foxglove::PlaybackWord::buffering;
      case PlaybackStatus::ended:
        return foxglove::PlaybackWord::ended;
    }
    return foxglove::PlaybackWord::paused;
  };
  const bool sought = state.seeks != known_seeks_;
  known_playback_ = state.changes;
  known_seeks_ = state.seeks;
  send_binary(out,
              foxglove::playback_message(
                  {word_of(state.status), static_cast<std::uint64_t>(state.now_ns), state.speed, sought}, request));
}

void FoxgloveSession::handle(const foxglove::PlaybackControl& message, Outgoing& out) {
  PlaybackPort* const playback = context_.gateway->playback();
  if (playback == nullptr) return report_problem("this gateway plays no recording", out);
  if (context_.options.read_only) return report_problem("playback: this gateway was started read-only", out);
  PlaybackRequest request{.play = message.play, .speed = message.speed, .seek_ns = {}};
  constexpr auto kLatest = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  if (message.seek_ns) request.seek_ns = static_cast<std::int64_t>(std::min(*message.seek_ns, kLatest));
  if (const auto done = playback->apply(request); !done) {
    count(context_.counters.refused);
    report_problem(done.error().text(), out);
  }
  send_playback(playback->state(), message.request, out);
}

void FoxgloveSession::report_playback(Outgoing& out) {
  PlaybackPort* const playback = context_.gateway->playback();
  if (playback == nullptr) return;
  const PlaybackState state = playback->state();
  if (state.changes != known_playback_) send_playback(state, {}, out);
}

// --- What is sent without being asked for.

bool FoxgloveSession::waiting() const {
  const bool may_begin_asset = asset_under_way_ ? asset_read_ : !assets_.empty();
  return may_begin_asset || topics_->waiting();
}

void FoxgloveSession::send(Outgoing& out) {
  if (asset_under_way_ && asset_read_ && out.empty()) asset_under_way_ = false;
  begin_asset(out);
  while (out.pending() < kMostAhead) {
    const std::optional<foxglove::Waiting> next = topics_->next();
    if (!next) return;
    out.push(frame_header(Opcode::binary, foxglove::kDataHead + next->payload->size()) +
             foxglove::data_head(next->subscription, next->time_ns));
    out.push(Chunk{next->payload, *next->payload});
  }
}

void FoxgloveSession::look(Timestamp now, Outgoing& out) {
  if (out.pending() >= kMostAhead) return;
  send_binary(
      out, foxglove::time_message(static_cast<std::uint64_t>(to_wall_clock_ns(context_.gateway->cell_clock().now()))));
  report_playback(out);
  if (const std::vector<foxglove::Channel> channels = topics_->new_channels(); !channels.empty())
    send_text(out, foxglove::advertise_message(channels));
  if (!last_dropped_.known() || now - last_dropped_ >= kDroppedPeriod) {
    last_dropped_ = now;
    report_dropped(out);
  }
  const bool subscribed = all_parameters_ || !parameters_.empty();
  if (!subscribed || looking_at_parameters_) return;
  if (last_parameters_.known() && now - last_parameters_ < kParameterPeriod) return;
  last_parameters_ = now;
  looking_at_parameters_ = read_parameters(
      [](FoxgloveSession& session, const auto& all, Outgoing& to) { session.send_changed_parameters(all, to); });
}

void FoxgloveSession::report_dropped(Outgoing& out) {
  const std::map<std::string, std::uint64_t> dropped = topics_->dropped();
  if (dropped == told_dropped_) return;
  told_dropped_ = dropped;
  std::string text;
  for (const auto& [topic, messages] : dropped)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", printable(topic), messages);
  if (text.empty()) return;
  send_text(out, foxglove::status_message(foxglove::StatusLevel::warning,
                                          "messages that were left out since this client reads too slowly: " + text,
                                          kDroppedId));
}

}  // namespace cellmirror::web
