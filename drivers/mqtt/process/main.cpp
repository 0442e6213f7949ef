// cellmirror-mqtt: one connection of cellmirror to an MQTT broker, confined. Started by cellmirror, with a channel
// (ipc/sandbox/channel.hpp) at its descriptors; ends with the connection, or with cellmirror.
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <ctime>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "drivers/mqtt/message/mqtt_message.hpp"
#include "drivers/mqtt/process/broker_session.hpp"
#include "drivers/mqtt/process/tcp_probe.hpp"
#include "ipc/sandbox/beating.hpp"
#include "ipc/sandbox/channel.hpp"
#include "ipc/sandbox/confinement.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::mqtt {
namespace {

constexpr Nanoseconds kBeat{50'000'000};
constexpr Nanoseconds kConnectWithin{3'000'000'000};  // TCP, each address
constexpr int kMostRequests = 256;                    // between two looks at the connection
constexpr std::uint64_t kAddresses = 256ULL << 20U;
constexpr int kGoodbyes = 20;  // rounds in which the broker may end the connection

class Connection {
 public:
  explicit Connection(Channel& channel) : channel_(channel) {}

  void run() {
    const auto wanted = wanted_connection();
    if (!wanted) return;
    const std::vector<std::string> readable{wanted->ca_file, wanted->certificate, wanted->key};
    channel_.set_confinement(
        confine_to_network({.address_space_bytes = kAddresses, .readable = readable, .tcp = true}));
    if (auto opened = open(*wanted); !opened) return send(ConnectionEnded{opened.error().what, opened.error().remedy});
    forbid_opening_files();
    send(BrokerAsked{});
    serve();
    if (session_->end()) send(ConnectionEnded{session_->end()->what, session_->end()->remedy});
  }

 private:
  std::optional<ConnectBroker> wanted_connection() {
    while (!channel_.ended()) {
      if (channel_.receive(message_) == RingResult::done) {
        const auto request = decode_request(message_);
        if (!request || !std::holds_alternative<ConnectBroker>(request->message)) return std::nullopt;
        return std::get<ConnectBroker>(request->message);
      }
      channel_.wait(kBeat, {});
      channel_.beat();
    }
    return std::nullopt;
  }

  Result<void> open(const ConnectBroker& wanted) {
    const Beating beating(channel_);  // the library waits for the connection as long as the kernel does
    auto session = BrokerSession::make(
        wanted,
        {.accepted = [this] { send(BrokerAccepted{}); },
         .subscription_refused = [this](const std::string& why) { send(SubscriptionRefused{why}); },
         .confirmed = [this](const MessageConfirmed& message) { send(message); },
         .received = [this](MessageReceived& message, std::span<const std::byte> payload) { send(message, payload); }});
    if (!session) return std::unexpected(session.error());
    session_ = std::move(*session);
    const auto address = answering_address(wanted.broker, wanted.port, kConnectWithin);
    if (!address) return std::unexpected(address.error());
    // TLS needs the name, which the library compares with the certificate.
    return session_->connect(wanted.tls ? wanted.broker : *address);
  }

  void serve() {
    while (!session_->end() && !channel_.ended()) {
      if (!take_requests()) return say_goodbye();
      channel_.beat();
      pollfd connection{session_->socket(), static_cast<short>(session_->wants_to_write() ? POLLIN | POLLOUT : POLLIN),
                        0};
      channel_.wait(kBeat, {&connection, 1});
      session_->read_and_write(connection.revents);
    }
  }

  // Returns false if the connection is to be ended.
  bool take_requests() {
    for (int i = 0; i < kMostRequests && channel_.receive(message_) == RingResult::done; ++i) {
      const auto request = decode_request(message_);
      if (!request || std::holds_alternative<DisconnectBroker>(request->message)) return false;
      if (const auto* topic = std::get_if<SubscribeTopic>(&request->message)) session_->subscribe(topic->topic);
      if (const auto* message = std::get_if<PublishMessage>(&request->message))
        session_->publish(*message, request->rest);
    }
    return true;
  }

  void say_goodbye() {
    session_->disconnect();
    for (int i = 0; i < kGoodbyes && !session_->end() && !channel_.ended(); ++i) {
      pollfd connection{session_->socket(), POLLIN, 0};
      channel_.wait(kBeat, {&connection, 1});
      channel_.beat();
      session_->read_and_write(connection.revents);
    }
  }

  // Waits for room in the ring: cellmirror reads within milliseconds or ends this process.
  void send(MqttEvent event, std::span<const std::byte> payload = {}) {
    encode(event, bytes_);
    constexpr timespec kPause{0, 1'000'000};
    while (!channel_.send(bytes_, payload.first(std::min(payload.size(), kMostForwarded))) && !channel_.ended()) {
      channel_.beat();
      nanosleep(&kPause, nullptr);
    }
  }

  Channel& channel_;
  std::unique_ptr<BrokerSession> session_;
  std::vector<std::byte> message_;  // reused
  std::vector<std::byte> bytes_;    // likewise
};

int run() {
  signal(SIGPIPE, SIG_IGN);  // OpenSSL writes to a socket that the broker has closed
  auto channel = Channel::attach();
  if (!channel) return 2;
  Connection(*channel).run();
  return 0;
}

}  // namespace
}  // namespace cellmirror::mqtt

int main() {
  int status = 1;
  try {
    status = cellmirror::mqtt::run();
  } catch (const std::exception&) {
    status = 1;
  }
  _exit(status);
}
