// A gateway without a cell: it answers commands and sends records of one robot that moves in steps.
//   ipc_test_gateway SCRIPT_KEY SENSOR_KEY REPLY_KEY [RATE_HZ]
// Commands: "echo TEXT" is done with TEXT, "silent" is never answered, anything else is refused. Prints "ready" and
// ends at SIGTERM.
#include <signal.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include "ipc/sysv/script_message_receiver.hpp"
#include "ipc/sysv/sensor_queue_output.hpp"

namespace {

using namespace cellmirror;

RobotState moving_robot(std::uint64_t step, Timestamp time) {
  RobotState robot;
  robot.id = "PUMA_762";
  robot.online = true;
  robot.sequence = step;
  robot.state = DataState::fresh;
  const double position = 0.25 * static_cast<double>(step % 8);
  robot.joints.push_back({"J_1", JointKind::revolute, position, 0.5, 1.5, DataState::fresh, time, time});
  robot.joints.push_back({"J_2", JointKind::prismatic, -position, 0, 0, DataState::stale, {}, time});
  robot.X_WT.translation() = Eigen::Vector3d(1, -2, 0.125);
  return robot;
}

int refuse(const Error& error) {
  std::fprintf(stderr, "ipc_test_gateway: %s\n", error.text().c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return 2;
  QueueConfig queues;
  queues.script_key = static_cast<std::int32_t>(std::strtol(argv[1], nullptr, 0));
  queues.sensor_key = static_cast<std::int32_t>(std::strtol(argv[2], nullptr, 0));
  queues.reply_key = static_cast<std::int32_t>(std::strtol(argv[3], nullptr, 0));
  const double rate_hz = argc > 4 ? std::atof(argv[4]) : 0;

  // Before any thread is made, so that all inherit it and only sigtimedwait takes the signal.
  sigset_t ending;
  sigemptyset(&ending);
  sigaddset(&ending, SIGTERM);
  ::pthread_sigmask(SIG_BLOCK, &ending, nullptr);

  auto sensor = SensorQueueOutput::open(queues, "test");
  if (!sensor) return refuse(sensor.error());
  ScriptMessageReceiver receiver(queues, "test");
  const auto started = receiver.start([&receiver](const ScriptMessage& message) {
    if (message.text == "silent") return;
    const bool echo = message.text.starts_with("echo ");
    receiver.reply(message.tag, {echo, echo ? message.text.substr(5) : "unknown command; try echo"});
  });
  if (!started) return refuse(started.error());
  std::puts("ready");
  std::fflush(stdout);

  timespec period{1, 0};
  if (rate_hz > 0) period = {0, static_cast<long>(1e9 / rate_hz)};
  for (std::uint64_t step = 1; ::sigtimedwait(&ending, nullptr, &period) != SIGTERM; ++step) {
    if (rate_hz <= 0) continue;
    const Timestamp now = SystemClock().now();
    const RobotState robots[] = {moving_robot(step, now)};
    (*sensor)->publish(now, robots, {});
  }
  receiver.stop();
  return 0;
}
