#include "app/io/publisher.hpp"

#include <algorithm>
#include <ctime>
#include <utility>

#include "app/snapshot/robot_description.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/rt/scheduling.hpp"
#include "rt_core/scene/camera_mount.hpp"

namespace cellmirror::app {

namespace {

// So long after the tick woke, its state is published even on a busy machine.
constexpr Nanoseconds kBehindTick{150'000};
constexpr Nanoseconds kLongestSleep{100'000'000};  // how long stopping may take

// Of the machine's time, whatever clock the cell goes by.
void sleep_for(Nanoseconds d) {
  const std::int64_t ns = std::max<std::int64_t>(0, d.count());
  const timespec wanted{ns / 1'000'000'000, ns % 1'000'000'000};
  clock_nanosleep(CLOCK_MONOTONIC, 0, &wanted, nullptr);
}

}  // namespace

void FindingsPublisher::publish_news(FindingsOutput& output, RangeSendMode mode) {
  const std::shared_ptr<const ProximityState> state = proximity_.latest();
  if (state && state->sequence != newest_proximity_) {
    outgoing_ = *state;
    outgoing_.events = proximity_.events_after(newest_event_);
    // The worker may have published newer results meanwhile: their events are published with the next ones.
    std::erase_if(outgoing_.events,
                  [&](const ProximityEvent& event) { return event.posture_time > state->posture_time; });
    if (!outgoing_.events.empty()) newest_event_ = outgoing_.events.back().sequence;
    newest_proximity_ = state->sequence;
    output.publish_proximity(outgoing_);
  } else if (state) {
    // Once more, without what has been told: the output itself sees that it grows old.
    outgoing_.events.clear();
    output.publish_proximity(outgoing_);
  }
  const std::shared_ptr<const RangeReadings> ranges = ranges_.latest();
  if (ranges && ranges->sequence != newest_ranges_) {
    newest_ranges_ = ranges->sequence;
    output.publish_ranges(ranges->readings, mode);
    output.publish_barriers(ranges->barriers);
  }
}

void take_efforts(const ForceState& forces, std::span<RobotState> robots) {
  for (RobotState& robot : robots) {
    if (robot.online) continue;
    const auto computed = std::ranges::find(forces.robots, robot.id, &RobotForces::id);
    if (computed == forces.robots.end() || computed->joints.size() != robot.joints.size()) continue;
    for (std::size_t i = 0; i < robot.joints.size(); ++i) robot.joints[i].effort = computed->joints[i].effort;
  }
}

Publisher::Publisher(engine::TickReader& ticks, const Board<CellState>& board, const ProximityBoard& proximity,
                     const Board<RangeReadings>& ranges, const Board<ForceState>& forces, const Clock& clock,
                     Nanoseconds tick_period, std::vector<PublishedOutput> outputs, TissueSources tissue)
    : ticks_(ticks),
      board_(board),
      forces_(forces),
      clock_(clock),
      tick_period_(tick_period),
      outputs_(std::move(outputs)),
      findings_(outputs_.size(), FindingsPublisher(proximity, ranges)),
      tissue_(std::move(tissue), outputs_.size()),
      due_(outputs_.size(), clock.now()),
      thread_([this](const std::stop_token& stop) { loop(stop); }) {}

Publisher::~Publisher() {
  thread_.request_stop();
  thread_.join();
}

void Publisher::loop(const std::stop_token& stop) {
  set_thread_name("publisher");
  while (!stop.stop_requested()) {
    const Timestamp now = clock_.now();
    const Timestamp due = std::min(publish_due(now), now + kLongestSleep);
    // The first tick at or after the due time, and a little later.
    const Timestamp tick = ticks_.newest().time;
    const std::int64_t periods =
        tick.known() ? std::max<std::int64_t>(1, (due - tick + tick_period_ / 2) / tick_period_) : 0;
    const Timestamp wanted =
        tick.known() ? std::clamp(tick + periods * tick_period_ + kBehindTick, now + kBehindTick, now + kLongestSleep)
                     : due;
    sleep_for(wanted - clock_.now());
  }
}

void Publisher::select_sending(const CellState& cell_state, std::span<const RobotState> robots) {
  std::size_t n = 0;
  wanted_.assign(robots.size(), false);
  if (sending_.size() < robots.size()) sending_.resize(robots.size());
  for (std::size_t i = 0; i < robots.size() && i < cell_state.robots.size(); ++i) {
    if (!cell_state.robots[i].sending) continue;
    wanted_[i] = true;
    sending_[n++] = robots[i];
  }
  sending_.resize(n);
}

void Publisher::publish_description(const CellState& cell_state) {
  const bool told = cell_state.cell->revision == described_revision_ && wanted_ == described_robots_;
  // Nothing was ever sent: there is nothing to take back either.
  if (told || (description_.empty() && sending_.empty())) return;
  described_revision_ = cell_state.cell->revision;
  described_robots_ = wanted_;
  std::string description = robot_description(*cell_state.cell, wanted_);
  if (description == description_) return;
  description_ = std::move(description);
  for (const PublishedOutput& output : outputs_) {
    if (output.description != nullptr) output.description->publish_description(description_);
  }
}

// Puts `next` before the next one.
void Publisher::publish_controllers(Timestamp now, Timestamp& next) {
  const std::shared_ptr<const CellState> cell_state = board_.latest();
  if (!cell_state || cell_state->controllers.empty()) return;
  const Timestamp by = now + tick_period_ / 2;
  if (controllers_.due(*cell_state, by)) controllers_.publish(*cell_state, ticks_.newest(), now, by);
  const Timestamp first = controllers_.next(*cell_state);
  if (first.known()) next = std::min(next, first);
}

Timestamp Publisher::publish_due(Timestamp now) {
  Timestamp next = now + kLongestSleep;
  // Where the time was set back, nothing waits until it is there again.
  for (std::size_t i = 0; i < due_.size(); ++i) due_[i] = std::min(due_[i], now + outputs_[i].period);
  publish_controllers(now, next);
  const bool any_due =
      std::any_of(due_.begin(), due_.end(), [now, this](Timestamp due) { return due <= now + tick_period_ / 2; });
  if (any_due) {
    const std::shared_ptr<const CellState> cell_state = board_.latest();
    const engine::TickState& state = ticks_.newest();
    const std::span<const RobotState> robots = builder_.build(*cell_state, state);
    for (const std::string& text : range_watch_.look(now, robots, cell_state->robots))
      log_warning("joint.range", "{}", text);
    select_sending(*cell_state, robots);
    publish_description(*cell_state);
    const std::shared_ptr<const ForceState> forces = forces_.latest();
    if (forces) take_efforts(*forces, sending_);
    const std::span<const FramePose> frames = builder_.frames(*cell_state, wanted_);
    tissue_.look(*cell_state, robots);
    for (std::size_t i = 0; i < outputs_.size(); ++i) {
      if (due_[i] > now + tick_period_ / 2) continue;
      outputs_[i].output->keep(now);
      if (!sending_.empty()) outputs_[i].output->publish(state.time, sending_, frames);
      if (outputs_[i].forces != nullptr && forces) outputs_[i].forces->publish_forces(*forces);
      if (outputs_[i].findings != nullptr)
        findings_[i].publish_news(*outputs_[i].findings, cell_state->range_send_mode);
      if (outputs_[i].tissue_events != nullptr) tissue_.publish_events(i, *outputs_[i].tissue_events);
      if (outputs_[i].tissue_shapes != nullptr) tissue_.publish_shapes(i, now, *outputs_[i].tissue_shapes);
      if (outputs_[i].cameras != nullptr && cell_state->display) {
        const std::vector<CameraState> cameras =
            scene::online_cameras(*cell_state->cell, builder_.poses(), *cell_state->display);
        if (!cameras.empty()) outputs_[i].cameras->publish_cameras(state.time, cameras);
      }
      due_[i] = due_[i] + outputs_[i].period;
      if (due_[i] < now) due_[i] = now + outputs_[i].period;  // it was late by more than a period
    }
  }
  for (const Timestamp due : due_) next = std::min(next, due);
  return next;
}

}  // namespace cellmirror::app
