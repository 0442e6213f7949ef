#include "drivers/mqtt/broker_link.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "drivers/mqtt/credentials.hpp"
#include "drivers/mqtt/internal/session.hpp"
#include "rt_core/base/contract.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/base/text.hpp"
#include "rt_core/rt/scheduling.hpp"

namespace cellmirror::mqtt {

namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kLongestWait = 500ms;  // the library looks after its own times
constexpr Nanoseconds kConnectWithin = 60s;  // to the first answer, with all addresses of a name
constexpr Nanoseconds kRefusalShown = 60s;

}  // namespace

BrokerLink::BrokerLink(MqttConfig config, std::string client_id, Conversation& conversation, WakeSignal& wake,
                       const Clock& clock)
    : config_(std::move(config)),
      client_id_(std::move(client_id)),
      conversation_(conversation),
      wake_(wake),
      clock_(clock),
      record_(SandboxRecord::make("cellmirror-mqtt", fmt::format("MQTT broker {} as {}", endpoint(), client_id_),
                                  Session::kMemory)) {}

BrokerLink::~BrokerLink() { stop(); }

void BrokerLink::start() {
  CELLMIRROR_EXPECTS(!thread_.joinable());
  thread_ = std::thread([this] { run(); });
}

void BrokerLink::stop() {
  if (!thread_.joinable()) return;
  stop_ = true;
  wake_.wake();
  thread_.join();
}

std::string BrokerLink::endpoint() const {
  return config_.broker.find(':') == std::string::npos ? fmt::format("{}:{}", config_.broker, config_.port)
                                                       : fmt::format("[{}]:{}", config_.broker, config_.port);
}

void BrokerLink::run() {
  set_thread_name("mqtt");
  while (!stop_) {
    Attempt ended;
    const Error why = attempt(ended);
    connected_ = false;
    std::vector<Outgoing> unconfirmed;
    for (auto& [number, message] : in_flight_) unconfirmed.push_back(std::move(message));
    in_flight_.clear();
    conversation_.lost(std::move(unconfirmed));
    if (stop_) return;
    set_problem(fmt::format("nothing reaches the MQTT broker {}: {}", endpoint(), why.text()));
    pause(ended.broke_down ? restart_delay_.after_end(clock_.now()) : delay_.after(ended.connected));
  }
}

// Messages wake it as well: they do not shorten the pause.
void BrokerLink::pause(Nanoseconds time) {
  const Timestamp end = clock_.now() + time;
  for (Timestamp now = clock_.now(); now < end && !stop_; now = clock_.now()) {
    constexpr Nanoseconds kLook = 100ms;
    std::this_thread::sleep_for(std::min<Nanoseconds>(end - now, kLook));
  }
}

void BrokerLink::set_problem(std::string text) {
  const std::scoped_lock lock(mutex_);
  ++counters_.failures;
  if (text != problem_) log_warning("mqtt.connection", "{}", text);
  problem_ = std::move(text);
}

Result<std::unique_ptr<Session>> BrokerLink::open() {
  std::optional<Credentials> credentials;
  if (!config_.credentials.empty()) {
    // Each time, so that a new password is found.
    auto read = read_credentials(config_.credentials);
    if (!read) return std::unexpected(read.error());
    credentials = *std::move(read);
  }
  return Session::make(config_, client_id_, credentials, conversation_.begin(), record_,
                       [this](const Incoming& message) {
                         {
                           const std::scoped_lock lock(mutex_);
                           ++counters_.received;
                         }
                         conversation_.received(message);
                       });
}

Result<void> BrokerLink::wait_for_answer(Session& session) {
  const Timestamp begin = clock_.now();
  Timestamp asked;
  while (!session.accepted()) {
    if (session.end()) return std::unexpected(*session.end());
    if (stop_) return fail("the gateway ends");
    const Timestamp now = clock_.now();
    if (session.asked() && !asked.known()) {
      asked = now;
      conversation_.asked();
    }
    if (asked.known() && now - asked >= kAnswerWithin)
      return fail(fmt::format("it has not answered for {:.0f} s", seconds(kAnswerWithin)),
                  "look whether it is a broker, and at its load");
    if (now - begin >= kConnectWithin)
      return fail(fmt::format("there was no connection within {:.0f} s", seconds(kConnectWithin)),
                  "look at the network, and at the addresses of the broker's name");
    static_cast<void>(wake_.wait(Nanoseconds{0}));
    session.wait(wake_.descriptor(), kLongestWait);
  }
  return {};
}

Error BrokerLink::attempt(Attempt& attempt) {
  auto session = open();
  if (!session) return session.error();
  if (auto answered = wait_for_answer(**session); !answered) {
    attempt.broke_down = (*session)->broke_down();
    return answered.error();
  }
  for (const std::string& topic : conversation_.subscriptions()) (*session)->subscribe(topic);
  conversation_.connected();
  connected_ = true;
  const Timestamp begin = clock_.now();
  {
    const std::scoped_lock lock(mutex_);
    ++counters_.connections;
    problem_.clear();
  }
  log_info("mqtt.connection", "connected to {}", endpoint());
  serve(**session);
  attempt = {clock_.now() - begin, (*session)->broke_down()};
  return (*session)->end().value_or(Error{"the gateway ends", {}});
}

void BrokerLink::serve(Session& session) {
  while (!session.end()) {
    if (stop_) return say_farewell(session);
    // What is put from here on is found by the next round.
    static_cast<void>(wake_.wait(Nanoseconds{0}));
    send_what_there_is(session);
    session.wait(wake_.descriptor(), kLongestWait);
    take_confirmations(session);
    if (const std::string& refused = session.refused_subscription(); !refused.empty()) {
      const std::scoped_lock lock(mutex_);
      problem_ = fmt::format(
          "the MQTT broker {} lets no commands through: {}; give the user of [mqtt] the right to "
          "subscribe to its command topic",
          endpoint(), refused);
    }
  }
}

void BrokerLink::send_what_there_is(Session& session) {
  while (in_flight_.size() < kMostInFlight && !session.end()) {
    auto message = conversation_.next();
    if (!message) return;
    send(session, *std::move(message));
    take_confirmations(session);
  }
}

void BrokerLink::send(Session& session, Outgoing message) {
  const auto number = session.publish(message);
  if (number) {
    in_flight_.emplace_back(*number, std::move(message));
    return;
  }
  const std::scoped_lock lock(mutex_);
  ++counters_.refused;
  refusal_ = fmt::format("a message on {} cannot be sent: {}", printable(message.topic), number.error().text());
  refused_at_ = clock_.now();
}

void BrokerLink::take_confirmations(Session& session) {
  for (const Session::Confirmation& confirmation : session.take_confirmations()) {
    const auto found = std::ranges::find(in_flight_, confirmation.number, &std::pair<int, Outgoing>::first);
    if (found == in_flight_.end()) continue;
    const std::scoped_lock lock(mutex_);
    if (confirmation.refusal.empty()) {
      ++counters_.sent;
      counters_.sent_bytes += found->second.bytes();
    } else {
      ++counters_.refused;
      refusal_ =
          confirmation.by_library
              ? fmt::format("a message on {} cannot be sent: {}", printable(found->second.topic), confirmation.refusal)
              : fmt::format(
                    "the MQTT broker {} refuses messages on {}: {}; give the user of [mqtt] the right "
                    "to publish there",
                    endpoint(), printable(found->second.topic), confirmation.refusal);
      refused_at_ = clock_.now();
    }
    in_flight_.erase(found);
  }
}

// What still waits goes first, as far as there is time.
void BrokerLink::say_farewell(Session& session) {
  const Timestamp until = clock_.now() + kFarewellWithin;
  const auto in_time = [&] { return !session.end() && clock_.now() < until; };
  constexpr Nanoseconds kLook = 20ms;
  bool all = false;
  while (in_time() && (!all || !in_flight_.empty())) {
    if (!all && in_flight_.size() < kMostInFlight) {
      auto message = conversation_.next();
      if (message) {
        send(session, *std::move(message));
      } else {
        all = true;
        for (Outgoing& last : conversation_.farewell()) send(session, std::move(last));
      }
    }
    session.wait(-1, all || in_flight_.size() >= kMostInFlight ? kLook : Nanoseconds{0});
    take_confirmations(session);
  }
  // Without this the broker publishes the last will.
  if (all && in_flight_.empty()) session.disconnect();
  while (in_time()) session.wait(-1, kLook);
}

BrokerLink::Counters BrokerLink::counters() const {
  const std::scoped_lock lock(mutex_);
  return counters_;
}

std::string BrokerLink::problem() const {
  const std::scoped_lock lock(mutex_);
  if (!problem_.empty()) return problem_;
  if (refused_at_.known() && clock_.now() - refused_at_ < kRefusalShown) return refusal_;
  return {};
}

}  // namespace cellmirror::mqtt
