// A gateway without a cell: it answers commands and sends records of one robot that moves in steps, or, where it is
// told to, one round of what sensors, collision tests and cameras tell before it is ready.
//   ipc_test_gateway SCRIPT_KEY SENSOR_KEY REPLY_KEY [RATE_HZ|findings]
// Commands: "echo TEXT" is done with TEXT, "silent" is never answered, anything else is refused. Prints "ready" and
// ends at SIGTERM.
#include <signal.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

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

RangeReading reading(const char* id, std::optional<double> distance, Timestamp time) {
  RangeReading made;
  made.id = id;
  made.posture_time = time;
  made.distance_m = distance;
  if (distance) made.object = "cell.box";
  made.range_m = 3;
  made.blind_zone_m = 0.1;
  made.in_blind_zone = distance && *distance < 0.1;
  return made;
}

CameraState camera(const char* name, bool mirrored, const char* tracks) {
  CameraState made;
  made.name = name;
  made.tracks = tracks;
  made.tracking = !made.tracks.empty();
  made.mirrored = mirrored;
  made.pan_rad = 0.25;
  made.tilt_rad = -0.5;
  made.focal_distance_m = 4;
  made.fovy_rad = 0.75;
  return made;
}

void send_findings(SensorQueueOutput& output) {
  const Timestamp now = SystemClock().now();
  RangeReading readings[] = {reading("USS_1", 0.25, now), reading("USS_2", {}, now), reading("USS_3", 0.05, now),
                             reading("USS_4", {}, now)};
  readings[3].doubtful = true;
  output.publish_ranges(readings, RangeSendMode::one_message_a_sensor);
  output.publish_ranges(readings, RangeSendMode::one_message_for_all);
  ProximityState state;
  state.posture_time = state.finished = now;
  state.sequence = 1;
  state.pairs = 45;
  state.names =
      std::make_shared<const std::vector<std::string>>(std::vector<std::string>{"cell.A", "cell.B", "cell.C"});
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  state.touching.push_back({0, 1, 0.002, zero, zero, {}, false});
  state.near.push_back({0, 1, 0, zero, zero, true, false, {}, {}});
  state.near.push_back({1, 2, 0.0125, zero, zero, true, false, {}, {}});
  state.events.push_back({1, ProximityChange::touched, "cell.A", "cell.B", 0, now});
  output.publish_proximity(state);
  const CameraState cameras[] = {camera("UMG_Kamera_1", true, "Gantry.J_2.Hand"), camera("CAMERA_5", false, "")};
  output.publish_cameras(now, cameras);
  TissueEvent clip;
  clip.number = 1;
  clip.time = now;
  clip.kind = TissueEventKind::clip;
  clip.at = {0.125, -0.5, 1};
  clip.value = 0.0625;
  std::string_view("cystic_artery").copy(clip.part.data(), clip.part.size() - 1);
  TissueEvent bleeds;
  bleeds.number = 2;
  bleeds.time = now;
  bleeds.kind = TissueEventKind::bleed;
  bleeds.value = 12.5;
  const NamedTissueEvent events[] = {{clip, "APPLIER", "liver"}, {bleeds, "", "liver"}};
  output.publish_tissue_events(events);
  BarrierReading gate;
  gate.name = "gate";
  gate.posture_time = now;
  BarrierReading door = gate;
  door.name = "door";
  door.interrupted = true;
  door.interruptions = 3;
  door.object = "cell.A";
  output.publish_barriers(std::array{gate, door});
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
  const bool findings = argc > 4 && std::string(argv[4]) == "findings";
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
  if (findings) send_findings(**sensor);
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
