#include "sim_devices/robot/rtde_robot.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>

namespace cellmirror::sim {
namespace {

constexpr std::uint32_t kPlaying = 2;          // runtime state of a program
constexpr std::size_t kMostWaiting = 1 << 20;  // of a client that does not read; then it is dropped

}  // namespace

RtdeRobot::RtdeRobot(const RtdeRobotConfig& config, std::unique_ptr<MotionSource> motion)
    : FaultyDevice(config.seed),
      config_(config),
      motion_(std::move(motion)),
      values_(rtde::kJoints),
      pacer_({}, period_of(config.rate_hz)) {}

Result<std::unique_ptr<RtdeRobot>> RtdeRobot::make(const RtdeRobotConfig& config,
                                                   std::unique_ptr<MotionSource> motion) {
  std::unique_ptr<RtdeRobot> device(new RtdeRobot(config, std::move(motion)));
  if (auto listening = device->listen(); !listening) return std::unexpected(listening.error());
  device->counters_.endpoint = fmt::format("{}:{}", config.address, config.port);
  device->counters_.robots = 1;
  device->counters_.samples_of_robot.resize(1);
  return device;
}

Result<void> RtdeRobot::listen() {
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(config_.port);
  if (inet_pton(AF_INET, config_.address.c_str(), &at.sin_addr) != 1)
    return fail(fmt::format("{} is not an IPv4 address", config_.address), "e.g. --address 127.0.0.1");
  listener_ = Descriptor(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const int one = 1;
  ::setsockopt(listener_.get(), SOL_SOCKET, SO_REUSEADDR, &one, sizeof(one));
  if (::bind(listener_.get(), reinterpret_cast<const sockaddr*>(&at), sizeof(at)) != 0 ||
      ::listen(listener_.get(), static_cast<int>(kMostClients)) != 0)
    return fail(fmt::format("cannot listen on {}:{}: {}", config_.address, config_.port, std::strerror(errno)),
                "choose another --port");
  return {};
}

void RtdeRobot::start(Timestamp now) {
  start_motion(now);
  started_ = now;
  pacer_ = Pacer(now, period_of(config_.rate_hz));
}

Timestamp RtdeRobot::next() const { return std::min(pacer_.next(), pipeline_.next()); }

void RtdeRobot::wait_until(Timestamp t) {
  const SystemClock clock;
  const Nanoseconds left = t - clock.now();
  if (left.count() <= 0) return;
  // What clients ask for can wait a millisecond; a period cannot.
  sleep_until(std::min(t, clock.now() + Nanoseconds(1'000'000)));
}

void RtdeRobot::work(Timestamp now) {
  accept_clients();
  for (Client& client : clients_) read(client);
  if (pacer_.due(now)) {
    note_lateness(pacer_.next(), now);
    send_sample(now);
    pacer_.advance(now);
  }
  flush(now);
  for (Client& client : clients_) send(client, {});
  std::erase_if(clients_, [](const Client& client) { return client.ended; });
}

void RtdeRobot::accept_clients() {
  while (true) {
    Descriptor socket(::accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!socket.valid()) return;
    if (clients_.size() >= kMostClients) continue;  // closes it
    const int one = 1;
    ::setsockopt(socket.get(), IPPROTO_TCP, TCP_NODELAY, &one, sizeof(one));
    clients_.emplace_back();
    clients_.back().socket = std::move(socket);
  }
}

void RtdeRobot::read(Client& client) {
  std::array<std::uint8_t, 4096> bytes{};
  const ssize_t count = ::recv(client.socket.get(), bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR)) client.ended = true;
  if (count <= 0) return;
  client.splitter.add(std::span(bytes).first(static_cast<std::size_t>(count)));
  while (const auto package = client.splitter.next()) {
    ++counters_.received;
    answer(client, *package);
  }
  if (client.splitter.broken()) client.ended = true;
}

void RtdeRobot::answer(Client& client, const rtde::Package& package) {
  using rtde::PackageType;
  switch (static_cast<PackageType>(package.type)) {
    case PackageType::version:
      return send(client, rtde::accepted(PackageType::version,
                                         rtde::decode_version_request(package.payload) == rtde::kProtocolVersion));
    case PackageType::outputs: {
      const auto request = rtde::decode_outputs_request(package.payload);
      client.has_all = request && request->variables == rtde::kAllVariables;
      const bool known = client.has_all || (request && request->variables == rtde::kVariables);
      const std::string_view types = client.has_all ? rtde::kAllVariableTypes : rtde::kVariableTypes;
      return send(client, rtde::outputs_answer({.recipe = FaultTraits<RtdeMessage>::kRecipe,
                                                .types = std::string(known ? types : "NOT_FOUND")}));
    }
    case PackageType::start:
      client.started = true;
      return send(client, rtde::accepted(PackageType::start, true));
    default:
      return;
  }
}

void RtdeRobot::send(Client& client, const rtde::Bytes& bytes) {
  client.waiting.insert(client.waiting.end(), bytes.begin(), bytes.end());
  while (!client.waiting.empty() && !client.ended) {
    const ssize_t count = ::send(client.socket.get(), client.waiting.data(), client.waiting.size(), MSG_NOSIGNAL);
    if (count < 0) {
      client.ended = errno != EAGAIN && errno != EINTR;
      break;
    }
    client.waiting.erase(client.waiting.begin(), client.waiting.begin() + count);
  }
  if (client.waiting.size() > kMostWaiting) client.ended = true;
}

void RtdeRobot::send_sample(Timestamp now) {
  if (!pipeline_.schedule().alive(now, {1, 0})) return;
  std::fill(values_.begin(), values_.end(), JointValue{});
  motion_->at(motion_time_s(now), values_);
  pipeline_.schedule().shape(now, 1, values_);
  RtdeMessage message;
  message.data.timestamp_s = seconds(now - started_);
  for (std::size_t j = 0; j < rtde::kJoints; ++j) {
    message.data.q[j] = values_[j].position;
    message.data.qd[j] = values_[j].velocity;
    message.data.moment[j] = values_[j].effort;
  }
  message.data.runtime_state = kPlaying;
  message.data.has_all = true;
  pipeline_.push(now, {now, {1, 0}, MessageKind::sample, std::move(message)});
}

Result<void> RtdeRobot::check(const FaultSpec& spec) const {
  if (spec.kind == FaultKind::bus_off) return fail("RTDE has no bus-off", "use death");
  if (spec.id) return fail("an RTDE package has no identifier", "remove id=");
  const bool of_values = spec.kind == FaultKind::frozen || spec.kind == FaultKind::jump || spec.kind == FaultKind::nan;
  if (spec.joint != 0 && !of_values)
    return fail(fmt::format("{}: one package carries all joints", name_of(spec.kind)), "remove joint=");
  return {};
}

bool RtdeRobot::transmit(const RtdeMessage& message) {
  bool any = false;
  for (Client& client : clients_) {
    if (!client.started || client.ended) continue;
    RtdeMessage encoded = message;
    encoded.data.has_all = client.has_all;  // a faulty one is encoded already
    FaultTraits<RtdeMessage>::encode(encoded);
    send(client, encoded.bytes);
    any = true;
  }
  return any;
}

DeviceStatus RtdeRobot::status(Timestamp now) const {
  DeviceStatus status = common_status(now);
  status.missed_periods = pacer_.missed();
  status.details.emplace_back("clients", clients_.size());
  return status;
}

}  // namespace cellmirror::sim
