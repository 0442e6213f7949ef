#include "app/recorder/recorder.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <utility>

#include "app/io/command_log.hpp"
#include "app/io/publisher.hpp"
#include "app/recording_layout/recording_names.hpp"
#include "drivers/dds/sensor_ranges.hpp"
#include "rt_core/rt/scheduling.hpp"

namespace cellmirror::app {

namespace {

// So long after the tick woke, its state is published even on a busy machine.
constexpr Nanoseconds kAfterTick{200'000};
constexpr Nanoseconds kIdle{50'000'000};             // how often is looked whether a recording has begun
constexpr Nanoseconds kBetweenFrames{20'000'000};    // for eyes
constexpr Nanoseconds kBetweenFindings{20'000'000};  // collisions, distances, forces
constexpr Nanoseconds kBetweenStatus{1'000'000'000};
constexpr std::size_t kMostTopicsOfAKind = 256;

// Of the machine's time, whatever clock the cell goes by.
void wait_for(Nanoseconds d) {
  const std::int64_t ns = std::max<std::int64_t>(0, d.count());
  const timespec wanted{ns / 1'000'000'000, ns % 1'000'000'000};
  clock_nanosleep(CLOCK_MONOTONIC, 0, &wanted, nullptr);
}

bool is_due(Timestamp now, Timestamp& last, Nanoseconds period) {
  // A time before the last one: a recording that is played was set back.
  if (last.known() && now >= last && now - last < period) return false;
  last = now;
  return true;
}

}  // namespace

Recorder::Recorder(Sources sources, RecordingHub& hub)
    : sources_(std::move(sources)),
      hub_(hub),
      pictures_(sources_.open_pictures, hub),
      alarms_(sources_.alarms, hub),
      tissue_(sources_.tissue, hub),
      inputs_(sources_.engine_inputs != nullptr ? std::make_unique<InputRecorder>(*sources_.engine_inputs, hub)
                                                : nullptr),
      thread_([this](const std::stop_token& stop) { loop(stop); }) {}

Recorder::~Recorder() {
  thread_.request_stop();
  thread_.join();
  switch_taps(false);
}

void Recorder::switch_taps(bool on) const {
  if (sources_.can_tap != nullptr) sources_.can_tap->set_on(on);
  if (sources_.payload_tap != nullptr) sources_.payload_tap->set_on(on);
}

void Recorder::loop(const std::stop_token& stop) {
  set_thread_name("recorder");
  while (!stop.stop_requested()) {
    const double rate_hz = hub_.rate_hz();
    switch_taps(rate_hz > 0);
    const Timestamp now = sources_.clock.now();
    if (inputs_) inputs_->look(now, sources_.board.latest().get());
    if (rate_hz <= 0) {
      last_tick_ = 0;
      newest_event_ = 0;
      newest_edge_.reset();
      alarms_.forget();
      tissue_.forget();
      wait_for(kIdle);
      continue;
    }
    const engine::TickState& state = sources_.ticks.newest();
    if (state.time.known()) look(state, rate_hz);
    record_inputs();
    record_status(now);
    pictures_.look(now);
    alarms_.look(now);
    tissue_.look(now, sources_.board.latest().get());
    // The tick that is due next, and a little later.
    const auto period = std::max(sources_.tick_period, Nanoseconds(static_cast<std::int64_t>(1e9 / rate_hz)));
    const std::int64_t ticks = std::max<std::int64_t>(1, (period + sources_.tick_period / 2) / sources_.tick_period);
    const Timestamp due = state.time + ticks * sources_.tick_period + kAfterTick;
    wait_for(std::clamp(due, now + kAfterTick, now + kIdle) - sources_.clock.now());
  }
}

void Recorder::look(const engine::TickState& state, double rate_hz) {
  const std::shared_ptr<const CellState> cell_state = sources_.board.latest();
  if (!cell_state) return;
  const std::shared_ptr<const ForceState> forces = sources_.forces.latest();
  const double tick_rate_hz = 1e9 / static_cast<double>(sources_.tick_period.count());
  const auto step = static_cast<std::uint64_t>(std::max(1.0, std::round(tick_rate_hz / rate_hz)));
  if (last_tick_ == 0 || state.tick >= last_tick_ + step || state.tick < last_tick_) {
    // Ticks that this thread came too late for.
    if (last_tick_ != 0 && state.tick >= last_tick_ + 2 * step && joints_)
      hub_.count_missed(joints_, (state.tick - last_tick_) / step - 1);
    last_tick_ = state.tick;
    record_tick(state, *cell_state, forces.get());
  }
  record_ranges();
  record_switches(to_wall_clock_ns(state.time), cell_state->switches);
  if (!is_due(state.time, last_findings_, kBetweenFindings)) return;
  record_proximity();
  if (forces) record_forces(*forces);
}

void Recorder::record_tick(const engine::TickState& state, const CellState& cell_state, const ForceState* forces) {
  const std::int64_t wall_ns = to_wall_clock_ns(state.time);
  const std::span<const RobotState> built = builder_.build(cell_state, state);
  robots_.assign(built.begin(), built.end());
  if (forces != nullptr) take_efforts(*forces, robots_);
  record_joints(wall_ns, cell_state, robots_);
  if (is_due(state.time, last_frames_, kBetweenFrames)) record_frames(wall_ns, cell_state);
}

// As they came, in the order of each stream.
void Recorder::record_inputs() {
  if (sources_.can_tap != nullptr) record_frames_of_can();
  if (sources_.payload_tap != nullptr) record_payloads();
}

void Recorder::record_payloads() {
  const auto topic_of = [this](PayloadKind kind, const std::string& robot) -> const TopicPtr& {
    TopicPtr& topic = payload_topics_[{kind, robot}];
    if (!topic)
      topic = kind == PayloadKind::dds ? OutputTopics::dds_samples(robot) : OutputTopics::rtde_packages(robot);
    return topic;
  };
  sources_.payload_tap->drain(
      [&](PayloadKind kind, const std::string& robot, Timestamp time, std::span<const std::byte> payload) {
        const TopicPtr& topic = topic_of(kind, robot);
        if (hub_.wants(*topic)) hub_.put(topic, to_wall_clock_ns(time), payload);
      },
      [&](PayloadKind kind, const std::string& robot, std::uint64_t payloads) {
        hub_.count_missed(topic_of(kind, robot), payloads);
      });
}

void Recorder::record_frames_of_can() {
  const auto topic_of_robot = [this](const std::string& robot) -> const TopicPtr& {
    auto topic = can_topics_.find(robot);
    if (topic == can_topics_.end()) topic = can_topics_.emplace(robot, OutputTopics::can_frames(robot)).first;
    return topic->second;
  };
  sources_.can_tap->drain(
      [&](const std::string& robot, const TappedCanFrame& tapped) {
        const TopicPtr& topic = topic_of_robot(robot);
        const std::int64_t wall_ns = to_wall_clock_ns(tapped.time);
        if (hub_.wants(*topic)) put_text(topic, wall_ns, can_frame_message(tapped.frame, wall_ns, tapped.sent));
      },
      [&](const std::string& robot, std::uint64_t frames) { hub_.count_missed(topic_of_robot(robot), frames); });
}

// Another topic of the same name where joints have come or go by other names.
const TopicPtr& Recorder::joint_topic(const CellState& cell_state, std::span<const RobotState> robots) {
  if (joints_ && joint_cell_ == cell_state.cell) return joints_;
  joint_cell_ = cell_state.cell;
  mcap::Texts joint_names;
  for (const RobotState& robot : robots)
    for (const RobotJointState& joint : robot.joints)
      joint_names[std::string(kJointKey) + names_.name(robot.id, joint.name)] = robot.id + "." + joint.name;
  if (joints_ && joint_names == joint_names_) return joints_;
  joints_ = OutputTopics::joint_states(joint_names);
  joint_names_ = std::move(joint_names);
  return joints_;
}

void Recorder::record_joints(std::int64_t wall_ns, const CellState& cell_state, std::span<const RobotState> robots) {
  if (robots.empty()) return;
  names_.see(robots);
  const TopicPtr& topic = joint_topic(cell_state, robots);
  if (!hub_.wants(*topic)) return;
  dds::fill_joint_state(dds::ros_time(wall_ns), robots, names_, joint_state_);
  encode(joint_state_, bytes_);
  hub_.put(topic, wall_ns, bytes_);
}

void Recorder::record_frames(std::int64_t wall_ns, const CellState& cell_state) {
  if (!hub_.wants(*tf_)) return;
  all_.assign(cell_state.robots.size(), true);
  dds::fill_transforms(dds::ros_time(wall_ns), builder_.frames(cell_state, all_), transforms_);
  if (transforms_.transforms.empty()) return;
  encode(transforms_, bytes_);
  hub_.put(tf_, wall_ns, bytes_);
}

void Recorder::record_proximity() {
  const std::shared_ptr<const ProximityState> state = sources_.proximity.latest();
  if (!state || state->sequence == newest_proximity_) return;
  // Those of before the recording are not its own.
  if (newest_event_ == 0 && last_tick_ != 0 && newest_proximity_ == 0) {
    const std::vector<ProximityEvent> before = sources_.proximity.events_after(0);
    if (!before.empty()) newest_event_ = before.back().sequence;
  }
  newest_proximity_ = state->sequence;
  if (hub_.wants(*collisions_))
    put_text(collisions_, to_wall_clock_ns(state->posture_time), collisions_message(*state));
  for (const ProximityEvent& event : sources_.proximity.events_after(newest_event_)) {
    put_text(events_, to_wall_clock_ns(event.posture_time), collision_event_message(event));
    newest_event_ = event.sequence;
    if (sources_.keeps_collisions && event.change == ProximityChange::touched) static_cast<void>(hub_.keep_ring());
  }
}

void Recorder::record_ranges() {
  const std::shared_ptr<const RangeReadings> ranges = sources_.ranges.latest();
  if (!ranges || ranges->sequence == newest_ranges_) return;
  newest_ranges_ = ranges->sequence;
  for (const RangeReading& reading : ranges->readings) {
    auto topic = range_topics_.find(reading.id);
    if (topic == range_topics_.end()) {
      if (range_topics_.size() >= kMostTopicsOfAKind) continue;
      topic = range_topics_.emplace(reading.id, OutputTopics::range(reading.id)).first;
    }
    const std::int64_t wall_ns = to_wall_clock_ns(reading.posture_time);
    if (!hub_.wants(*topic->second) || !dds::fill_range(dds::ros_time(wall_ns), reading, range_)) continue;
    encode(range_, bytes_);
    hub_.put(topic->second, wall_ns, bytes_);
  }
}

void Recorder::record_forces(const ForceState& state) {
  if (state.sequence == newest_forces_) return;
  newest_forces_ = state.sequence;
  const std::int64_t wall_ns = to_wall_clock_ns(state.posture_time);
  if (hub_.wants(*forces_) && !state.robots.empty()) put_text(forces_, wall_ns, forces_message(state));
  for (const RobotForces& robot : state.robots) {
    if (!fill_tcp_wrench(dds::ros_time(wall_ns), robot, wrench_)) continue;
    auto topic = wrench_topics_.find(robot.id);
    if (topic == wrench_topics_.end()) {
      if (wrench_topics_.size() >= kMostTopicsOfAKind) continue;
      topic = wrench_topics_.emplace(robot.id, OutputTopics::wrench(robot.id)).first;
    }
    encode(wrench_, bytes_);
    hub_.put(topic->second, wall_ns, bytes_);
  }
}

void Recorder::record_switches(std::int64_t wall_ns, const FootSwitchSnapshot& switches) {
  if (switches.key == 0 || (switches.edges == newest_edge_ && switches.inputs_on == inputs_on_)) return;
  newest_edge_ = switches.edges;
  inputs_on_ = switches.inputs_on;
  if (hub_.wants(*switches_)) put_text(switches_, wall_ns, foot_switches_message(switches.edges, switches.inputs_on));
}

void Recorder::record_status(Timestamp now) {
  if (!hub_.wants(*status_) || !is_due(now, last_status_, kBetweenStatus)) return;
  put_text(status_, to_wall_clock_ns(now), sources_.status());
}

void RecordedTexts::log(LogLevel level, std::string_view kind, std::string_view text) {
  if (!hub_.wants(*log_)) return;
  const std::int64_t wall_ns = to_wall_clock_ns(clock_.now());
  std::vector<std::byte> bytes;
  encode_log(dds::ros_time(wall_ns), level, kind, text, bytes);
  hub_.put(log_, wall_ns, bytes);
}

void RecordedTexts::command(const CommandRecord& record) {
  if (!hub_.wants(*commands_)) return;
  const std::string text = command_line_of(record);
  hub_.put(commands_, record.wall_ns, mcap::view_of(text));
}

void RecordedTexts::switch_changed(const FootSwitchChange& change) {
  if (!hub_.wants(*switch_changes_)) return;
  const std::int64_t wall_ns = to_wall_clock_ns(change.time);
  const std::string text = foot_switch_change_message(change, wall_ns);
  hub_.put(switch_changes_, wall_ns, mcap::view_of(text));
}

}  // namespace cellmirror::app
