#include "sim_devices/robot/runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "sim_devices/base/process.hpp"

namespace cellmirror::sim {
namespace {

nlohmann::ordered_json counts(const DeviceStatus& status) {
  nlohmann::ordered_json sent;
  for (std::size_t i = 0; i < status.sent.size(); ++i) sent[std::string(kMessageKindNames[i])] = status.sent[i];
  return sent;
}

nlohmann::ordered_json to_json(const DeviceStatus& status) {
  nlohmann::ordered_json json;
  json["endpoint"] = status.endpoint;
  json["first_robot"] = status.first_robot;
  json["robots"] = status.robots;
  json["sent"] = counts(status);
  json["samples_of_robot"] = status.samples_of_robot;
  json["refused"] = status.refused;
  json["received"] = status.received;
  json["missed_periods"] = status.missed_periods;
  json["latest_start_s"] = status.latest_s;
  for (const auto& [name, value] : status.details) json[name] = value;
  for (const auto& [name, value] : status.quantities) json[name] = value;
  json["faults"] = nlohmann::ordered_json::array();
  for (const FaultStatus& fault : status.faults) {
    json["faults"].push_back(
        {{"id", fault.id}, {"fault", fault.text}, {"in_force", fault.in_force}, {"applied", fault.applied}});
  }
  return json;
}

}  // namespace

struct Runner::Seat {
  std::unique_ptr<SimulatedDevice> device;
  std::mutex mutex;
  std::thread thread;
  std::atomic<bool> stop{false};
};

Runner::Runner(RunnerConfig config) : config_(std::move(config)) {}

Runner::~Runner() {
  for (const auto& seat : seats_) {
    seat->stop = true;
    if (seat->thread.joinable()) seat->thread.join();
  }
}

Result<std::unique_ptr<Runner>> Runner::make(RunnerConfig config,
                                             std::vector<std::unique_ptr<SimulatedDevice>> devices) {
  std::unique_ptr<Runner> runner(new Runner(std::move(config)));
  install_signal_handlers();
  std::signal(SIGTTIN, SIG_IGN);  // in the background of a terminal, standard input is simply not there
  for (auto& device : devices) {
    runner->seats_.push_back(std::make_unique<Seat>());
    runner->seats_.back()->device = std::move(device);
  }
  if (!runner->config_.control_path.empty()) {
    if (auto opened = runner->control_.open(runner->config_.control_path); !opened) {
      return std::unexpected(opened.error());
    }
  }
  if (runner->config_.watch_standard_input) runner->control_.watch_standard_input();
  runner->started_ = runner->clock_.now();
  for (const FaultSpec& fault : runner->config_.faults) {
    if (auto added = runner->execute(AddFault{fault}); !added) return std::unexpected(added.error());
  }
  return runner;
}

void Runner::run() {
  if (config_.seconds) ends_ = started_ + Nanoseconds(std::llround(*config_.seconds * 1e9));
  for (const auto& seat : seats_) {
    seat->device->start(started_);
    seat->thread = std::thread([this, &seat] { work(*seat); });
  }
  while (!quit_ && !signalled()) {
    const Nanoseconds left = ends_ - clock_.now();
    if (left.count() <= 0) break;
    // Rounded up, and often enough to see a signal that came between the test and the wait.
    const auto wait_ms = std::min<std::int64_t>((left.count() + 999'999) / 1'000'000, 100);
    control_.serve(static_cast<int>(wait_ms), [this](std::string_view line) { return answer(line); });
  }
  for (const auto& seat : seats_) seat->stop = true;
  for (const auto& seat : seats_) seat->thread.join();
}

void Runner::work(Seat& seat) {
  if (!become_punctual(config_.priority)) {
    fmt::print(stderr, "{}: no SCHED_FIFO for this user; sending with ordinary priority\n", config_.program);
  }
  constexpr Nanoseconds kLongestWait{20'000'000};  // so that commands and the end are detected
  while (!seat.stop) {
    Timestamp next;
    {
      const std::lock_guard lock(seat.mutex);
      const Timestamp now = clock_.now();
      if (now >= ends_) return;
      seat.device->work(now);
      next = seat.device->next();
    }
    seat.device->wait_until(std::min({next, ends_, clock_.now() + kLongestWait}));
  }
}

Result<std::string> Runner::execute(const ControlCommand& command) {
  std::string done;
  for (const auto& seat : seats_) {
    const std::lock_guard lock(seat->mutex);
    // Until start, windows count from the start.
    const auto one = seat->device->execute(command, seat->thread.joinable() ? clock_.now() : started_);
    if (!one) return one;
    done = *one;
  }
  return done;
}

std::string Runner::answer(std::string_view line) {
  for (const auto& seat : seats_) {
    const std::lock_guard lock(seat->mutex);
    const auto own = seat->device->execute_own(line, clock_.now());
    if (own) return *own ? "ok: " + **own : "error: " + own->error().text();
  }
  const auto command = parse_control_command(line);
  if (!command) return "error: " + command.error().text();
  if (std::holds_alternative<Quit>(*command)) {
    quit_ = true;
    return "ok: quits";
  }
  if (std::holds_alternative<AskStatus>(*command)) return report();
  if (std::holds_alternative<AskHelp>(*command)) return control_help();
  const auto done = execute(*command);
  return done ? "ok: " + *done : "error: " + done.error().text();
}

std::string Runner::report() const {
  const Timestamp now = clock_.now();
  nlohmann::ordered_json json;
  json["device"] = config_.kind;
  json["duration_s"] = seconds(std::min(now, ends_) - started_);
  nlohmann::ordered_json total;
  for (const std::string_view kind : kMessageKindNames) total[std::string(kind)] = std::uint64_t{0};
  nlohmann::ordered_json devices = nlohmann::ordered_json::array();
  std::uint64_t refused = 0;
  for (const auto& seat : seats_) {
    const std::lock_guard lock(seat->mutex);
    const DeviceStatus status = seat->device->status(now);
    for (std::size_t i = 0; i < status.sent.size(); ++i) {
      auto& sum = total[std::string(kMessageKindNames[i])];
      sum = sum.get<std::uint64_t>() + status.sent[i];
    }
    refused += status.refused;
    devices.push_back(to_json(status));
  }
  json["sent"] = total;
  json["refused"] = refused;
  json["channels"] = devices;
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace cellmirror::sim
