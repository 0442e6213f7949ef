#include "app/workers/tissue_worker.hpp"

#include <algorithm>
#include <utility>

#include "app/workers/tick_phase.hpp"
#include "rt_core/rt/scheduling.hpp"
#include "rt_core/tissue/body/element_kernel.hpp"

namespace cellmirror::app {

namespace {

constexpr Nanoseconds kPeriod{1'000'000};
// Further behind than this, milliseconds are given up: the tissue would run fast to catch up.
constexpr Nanoseconds kMostBehind{4'000'000};
// After a step that took longer, the next millisecond is given up, and the thread rests for a quarter of what it took:
// whatever its priority, the rest of the gateway has its share of the processors.
constexpr Nanoseconds kLongStep{800'000};
constexpr Nanoseconds kBetweenReports{20'000'000};
constexpr Nanoseconds kBetweenViews{33'000'000};
constexpr Nanoseconds kViewsAfterRequest{1'000'000'000};
constexpr std::chrono::milliseconds kLongestWaitForView{100};

}  // namespace

TissueWorker::TissueWorker(tissue::World world, std::shared_ptr<geometry::SolidLibrary> solids, engine::Engine& engine,
                           engine::TickReader& ticks, const Board<CellState>& cell_states, const Clock& clock)
    : engine_(engine),
      ticks_(ticks),
      cell_states_(cell_states),
      clock_(clock),
      stepper_(std::move(world), std::move(solids)) {}

Result<std::unique_ptr<TissueWorker>> TissueWorker::make(const std::vector<tissue::ObjectDescription>& objects,
                                                         const std::vector<tissue::Connection>& connections,
                                                         std::shared_ptr<geometry::SolidLibrary> solids,
                                                         engine::Engine& engine, engine::TickReader& ticks,
                                                         const Board<CellState>& cell_states, const Clock& clock) {
  if (objects.empty()) return nullptr;
  Result<tissue::World> world = tissue::World::make(objects, connections);
  if (!world) return std::unexpected(world.error());
  return std::make_unique<TissueWorker>(*std::move(world), std::move(solids), engine, ticks, cell_states, clock);
}

TissueWorker::~TissueWorker() { stop(); }

void TissueWorker::stop() {
  if (!thread_.joinable()) return;
  thread_.request_stop();
  wake_.wake();
  thread_.join();
}

void TissueWorker::start(RealTimePolicy policy, int priority) {
  thread_ = std::jthread([this, policy, priority](const std::stop_token& stop) {
    set_thread_name(ticks_.name());
    // Pictures, which take much longer, would else delay forces by their time slices.
    const bool asked = policy != RealTimePolicy::off;
    if (!asked || !set_real_time_scheduling(policy, std::max(1, priority)).ok) prefer_short_work();
    loop(stop);
  });
}

Result<void> TissueWorker::request(std::vector<tissue::Command> commands) {
  const std::scoped_lock lock(mutex_);
  if (requests_.size() + commands.size() > kMostRequests) {
    return fail("the simulation of tissue has not taken its last commands yet", "send the command again in a moment");
  }
  std::ranges::move(commands, std::back_inserter(requests_));
  return {};
}

std::shared_ptr<const TissueView> TissueWorker::view() {
  const std::int64_t now_ns = clock_.now().ns;
  const Nanoseconds since_request{now_ns - view_wanted_ns_.exchange(now_ns, std::memory_order_relaxed)};
  if (since_request > kViewsAfterRequest && thread_.joinable()) {
    // The newest one may be as old as the last request.
    std::unique_lock lock(view_mutex_);
    view_came_.wait_for(lock, kLongestWaitForView, [&] { return view_time_ns_ >= now_ns; });
  }
  return views_.latest();
}

void TissueWorker::take_requests() {
  {
    const std::scoped_lock lock(mutex_);
    taken_.swap(requests_);
  }
  for (const tissue::Command& command : taken_) stepper_.world().apply(command);
  taken_.clear();
}

void TissueWorker::publish_forces(const engine::TickState& tick) {
  for (const tissue::InstrumentResponse& response : stepper_.world().responses()) {
    const auto haptic = std::ranges::find(cell_state_->haptics, response.slot, &HapticSnapshot::slot);
    if (haptic == cell_state_->haptics.end() || !haptic->online) continue;
    Latest<haptics::TissueForce>& inlet = engine_.tissue_inlet(haptic->channel);
    inlet.writable() = {.sequence = ++sequence_,
                        .posture_time = tick.time,
                        .slot = static_cast<std::uint8_t>(response.slot),
                        .x_ref = response.x_ref,
                        .force_W = response.force_W,
                        .torque_W = response.torque_W,
                        .stiffness = response.stiffness,
                        .contacts = response.contacts,
                        .held = response.held};
    inlet.publish();
    pose_to_force_.record(clock_.now() - tick.time);
  }
}

void TissueWorker::publish_loads(const engine::TickState& tick) {
  std::shared_ptr<InstrumentLoads> out = load_pool_.take();
  out->posture_time = tick.time;
  out->loads.clear();
  for (const tissue::InstrumentResponse& response : stepper_.world().responses()) {
    const auto instrument = std::ranges::find(stepper_.instruments(), response.slot, &tissue::InstrumentPose::slot);
    if (instrument == stepper_.instruments().end()) continue;
    const Eigen::Matrix3d R_TW = instrument->X_WT.linear().transpose();
    out->loads.push_back({.slot = static_cast<std::uint8_t>(response.slot),
                          .force_T = R_TW * response.force_W,
                          .torque_T = R_TW * response.torque_W,
                          .contacts = response.contacts});
  }
  loads_.publish(std::move(out));
}

void TissueWorker::publish_report(Timestamp now) {
  if (reported_.known() && now - reported_ < kBetweenReports) return;
  reported_ = now;
  auto report = std::make_shared<TissueReport>();
  stepper_.world().describe(report->state);
  report->rate_hz = rate_.read(now, steps_);
  report->late_steps = late_steps_;
  report->compute = compute_.snapshot();
  report->pose_to_force = pose_to_force_.snapshot();
  report->simd = tissue::simd_target();
  reports_.publish(std::move(report));
}

void TissueWorker::publish_view(Timestamp now) {
  if (viewed_.known() && now - viewed_ < kBetweenViews) return;
  const Nanoseconds since_request{now.ns - view_wanted_ns_.load(std::memory_order_relaxed)};
  if (viewed_.known() && since_request > kViewsAfterRequest) return;
  viewed_ = now;
  auto view = std::make_shared<TissueView>();
  stepper_.world().view(*view, cell_state_->tissue && cell_state_->tissue->network_shown);
  views_.publish(std::move(view));
  {
    const std::scoped_lock lock(view_mutex_);
    view_time_ns_ = now.ns;
  }
  view_came_.notify_all();
}

// How old the posture of the step was when it began.
Nanoseconds TissueWorker::step() {
  const engine::TickState& tick = ticks_.newest();
  const Timestamp begin = clock_.now();
  take_requests();
  if (stepper_.step(*cell_state_, tick)) {
    publish_forces(tick);
    publish_loads(tick);
    ++steps_;
  }
  compute_.record(clock_.now() - begin);
  return begin - tick.time;
}

void TissueWorker::loop(const std::stop_token& stop) {
  Timestamp next = clock_.now() + kPeriod;
  while (!stop.stop_requested()) {
    cell_state_ = cell_states_.latest();
    const Timestamp begin = clock_.now();
    if (cell_state_) {
      next = next + phase_change(step(), kPeriod);
      publish_report(clock_.now());
      publish_view(clock_.now());
    }
    const Timestamp now = clock_.now();
    next = next + kPeriod;
    if (now - begin > kLongStep) {
      next = std::max(next + kPeriod, now + (now - begin) / 4);
      ++late_steps_;
    }
    while (now - next > kMostBehind) {
      next = next + kPeriod;
      ++late_steps_;
    }
    if (next > now) wake_.wait(next - now);
  }
}

}  // namespace cellmirror::app
