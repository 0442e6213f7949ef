#include "drivers/mqtt/internal/session.hpp"

#include <fmt/format.h>

#include <ctime>
#include <utility>

#include "rt_core/base/text.hpp"

namespace cellmirror::mqtt {

namespace {

constexpr int kMostEvents = 1024;  // a call of wait()
constexpr int kMostInFlight = 4096;
constexpr std::size_t kMostReason = 400;

std::string_view text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

Session::Session(std::unique_ptr<SandboxProcess> process, std::shared_ptr<SandboxRecord> record,
                 std::function<void(const Incoming&)> received)
    : process_(std::move(process)), record_(std::move(record)), received_(std::move(received)) {}

Result<std::unique_ptr<Session>> Session::make(const MqttConfig& config, const std::string& client_id,
                                               const std::optional<Credentials>& credentials, const Outgoing& will,
                                               std::shared_ptr<SandboxRecord> record,
                                               std::function<void(const Incoming&)> received) {
  auto process = SandboxProcess::start({.program = "cellmirror-mqtt",
                                        .subject = record->report().subject,
                                        .channel = kMqttChannel,
                                        .memory_bytes = kMemory},
                                       record);
  if (!process) return std::unexpected(process.error());
  std::unique_ptr<Session> made(new Session(std::move(*process), std::move(record), std::move(received)));
  const bool sent = made->send(ConnectBroker{.broker = config.broker,
                                             .port = config.port,
                                             .tls = config.tls,
                                             .ca_file = config.ca_file,
                                             .certificate = config.certificate,
                                             .key = config.key,
                                             .has_credentials = credentials.has_value(),
                                             .user = credentials ? credentials->user : std::string(),
                                             .password = credentials ? credentials->password : std::string(),
                                             .client_id = client_id,
                                             .old_protocol = config.old_protocol,
                                             .keep_alive_s = config.keep_alive_s,
                                             .will_topic = will.topic,
                                             .will_payload = will.payload,
                                             .will_qos = will.qos,
                                             .will_retain = will.retain});
  if (!sent) return fail("cellmirror-mqtt does not read");
  return made;
}

Session::~Session() {
  if (broke_down_) return;
  static_cast<void>(process_->end("was stopped"));
  record_->stopped();
}

bool Session::send(MqttRequest request, std::string_view payload) {
  encode(request, bytes_);
  constexpr int kTries = 100;
  constexpr timespec kPause{0, 5'000'000};
  for (int i = 0; i < kTries && !end_; ++i) {
    if (process_->channel().send(bytes_, std::as_bytes(std::span(payload)))) return true;
    if (bytes_.size() + payload.size() > kMqttChannel.longest_message) return false;
    take_events();  // otherwise each side could wait for the other to read
    nanosleep(&kPause, nullptr);
  }
  return false;
}

void Session::subscribe(const std::string& topic) {
  if (!send(SubscribeTopic{topic})) break_down("does not read");
}

Result<int> Session::publish(const Outgoing& message) {
  const int number = last_number_ + 1;
  last_number_ = number;  // a confirmation may come before the call returns
  if (send(PublishMessage{number, message.topic, message.qos, message.retain, message.correlation}, message.payload))
    return number;
  if (bytes_.size() + message.payload.size() > kMqttChannel.longest_message)
    return fail(
        fmt::format("it has {} bytes, but at most {} are possible", message.bytes(), kMqttChannel.longest_message),
        "divide it");
  return fail("cellmirror-mqtt does not read messages", "wait until the gateway has replaced the process");
}

std::vector<Session::Confirmation> Session::take_confirmations() { return std::exchange(confirmations_, {}); }

void Session::disconnect() { static_cast<void>(send(DisconnectBroker{})); }

void Session::wait(int wake, Nanoseconds timeout) {
  if (end_) return;
  process_->wait(timeout, wake);
  take_events();
  if (end_) return;
  if (const auto why = process_->check(clock_.now())) {
    take_events();  // the reason, if the connection has ended
    if (!end_) break_down(*why);
  }
}

void Session::break_down(const std::string& why) {
  if (end_) return;
  const std::string reason = process_->end(why);
  broke_down_ = true;
  record_->ended(reason, true);
  end_ = Error{fmt::format("cellmirror-mqtt {}", reason),
               "it starts again by itself; if this repeats, look for a broker that sends what MQTT does not permit"};
}

void Session::take_events() {
  for (int i = 0; i < kMostEvents && process_->receive(message_); ++i) {
    const auto event = decode_event(message_);
    const bool good = event && std::visit([&](const auto& one) { return take(one, event->rest); }, event->message);
    if (!good) return break_down("sent a message that it may not send");
  }
}

bool Session::take(const BrokerAsked& /*event*/, std::span<const std::byte> /*rest*/) {
  return !std::exchange(asked_, true);
}

bool Session::take(const BrokerAccepted& /*event*/, std::span<const std::byte> /*rest*/) {
  accepted_ = true;
  return asked_;
}

bool Session::take(const ConnectionEnded& event, std::span<const std::byte> /*rest*/) {
  if (!end_) end_ = Error{printable(event.what, kMostReason), printable(event.remedy, kMostReason)};
  return true;
}

bool Session::take(const SubscriptionRefused& event, std::span<const std::byte> /*rest*/) {
  refused_subscription_ = printable(event.what, kMostReason);
  return true;
}

bool Session::take(const MessageConfirmed& event, std::span<const std::byte> /*rest*/) {
  if (event.number < 1 || event.number > last_number_ || confirmations_.size() >= kMostInFlight) return false;
  confirmations_.push_back({event.number, printable(event.refusal, kMostReason), event.by_library});
  return true;
}

bool Session::take(const MessageReceived& event, std::span<const std::byte> rest) {
  received_({.topic = event.topic,
             .payload = text_of(rest),
             .retained = event.retained,
             .response_topic = event.response_topic,
             .correlation = event.correlation});
  return true;
}

}  // namespace cellmirror::mqtt
