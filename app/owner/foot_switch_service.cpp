#include "app/owner/foot_switch_service.hpp"

#include <algorithm>
#include <utility>

#include "rt_core/base/log.hpp"

namespace cellmirror::app {

namespace {

constexpr Nanoseconds kLookAfter{200'000'000};  // how often the memory itself is asked after (system calls)
constexpr int kEdgesInATurn = 1024;             // a flood of changes must not hold the owner up
constexpr std::size_t kShownInputs = 64;
constexpr std::size_t kShownFiles = 16;
constexpr std::string_view kLogKind = "foot-switches";

}  // namespace

FootSwitchService::FootSwitchService(Options options, script::ScriptRunner& runner, const KismetHome& home,
                                     const Clock& clock)
    : options_(std::move(options)), clock_(clock), scripts_(runner, home, clock) {
  scripts_.on_first_command([this](Nanoseconds after) { first_command_.record(after); });
}

Result<void> FootSwitchService::prepare() {
  const FootSwitchSettings& settings = options_.settings;
  if (!settings.key) return {};
  if (auto made = set_memory(*settings.key, settings.bytes); !made) return made;
  return settings.online ? set_online(true) : Result<void>();
}

Result<void> FootSwitchService::set_memory(std::int32_t key, std::size_t bytes) {
  if (memory_ && memory_->options().key == key && memory_->options().bytes == bytes) return {};
  SharedSegment::Options wanted{"foot switches", key, bytes, options_.settings.mode, options_.instance};
  const bool online = reader_ != nullptr;
  // The same key in another size: the old memory has to go before. If the new one cannot be had, the old one comes
  // back, without those who were attached to it.
  const bool same_key = memory_ && memory_->options().key == key;
  std::optional<SharedSegment::Options> before;
  if (same_key) {
    before = memory_->options();
    stop_watching();
    memory_.reset();
  }
  auto made = SharedSegment::make(std::move(wanted));
  if (!made) {
    if (before) {
      if (auto again = SharedSegment::make(*before)) memory_ = std::move(*again);
      if (online && memory_) start_watching();
    }
    return std::unexpected(std::move(made.error()));
  }
  stop_watching();
  memory_ = std::move(*made);
  trouble_.clear();
  last_check_ = {};
  if (online) start_watching();
  return {};
}

void FootSwitchService::forget_waiting() {
  take_edges();
  scripts_.forget();
}

Result<void> FootSwitchService::set_online(bool online) {
  if (!online) {
    stop_watching();
    scripts_.forget();
    return {};
  }
  if (!memory_) {
    return fail("no memory of binary inputs is set",
                "name it with bin_ela_shm <send_type> <be_shmkey> <be_buflen>, or in [foot_switches] of the cell file");
  }
  if (!reader_) start_watching();
  return {};
}

void FootSwitchService::start_watching() {
  reader_ = std::make_unique<footswitch::SwitchReader>(
      memory_->memory(), clock_,
      footswitch::SwitchReader::Options{
          .debounce = options_.settings.debounce, .priority = options_.priority, .wake = options_.wake});
}

void FootSwitchService::stop_watching() {
  if (!reader_) return;
  // First of all: the last change may be the one that switches something off.
  reader_->stop();
  footswitch::SwitchEdge edge;
  for (std::size_t taken = 0; taken < footswitch::kEdgeQueue && reader_->next(edge); ++taken) take(edge);
  const footswitch::SwitchReader::Counters last = reader_->counters();
  earlier_.looks += last.looks;
  earlier_.edges += last.edges;
  earlier_.dropped += last.dropped;
  earlier_.bounces += last.bounces;
  reader_.reset();
}

void FootSwitchService::take_edges() {
  footswitch::SwitchEdge edge;
  for (int taken = 0; taken < kEdgesInATurn && reader_ && reader_->next(edge); ++taken) take(edge);
}

void FootSwitchService::take(const footswitch::SwitchEdge& edge) {
  scripts_.add({edge.input, edge.on, edge.not_told});
  if (options_.changed) options_.changed({.input = edge.input, .on = edge.on, .time = edge.time});
}

bool FootSwitchService::follow() {
  take_edges();
  if (memory_ && clock_.now() - last_check_ > kLookAfter) check_memory();
  return scripts_.follow();
}

void FootSwitchService::check_memory() {
  last_check_ = clock_.now();
  users_ = memory_->users();
  if (!users_.gone) return;
  if (auto renewed = memory_->renew(); !renewed) {
    trouble_ = renewed.error().text();
    log_warning(kLogKind, "the memory of the foot switches is lost: {}", trouble_);
    return;
  }
  trouble_.clear();
  log_warning(kLogKind, "the memory of the foot switches was removed by another process and is created again");
}

FootSwitchSnapshot FootSwitchService::snapshot() const {
  FootSwitchSnapshot snapshot;
  if (memory_) {
    snapshot.key = memory_->options().key;
    snapshot.bytes = memory_->options().bytes;
    snapshot.inputs = 8 * std::min(snapshot.bytes, footswitch::kMostSwitchBytes);
    snapshot.attached = users_.attached > 0 ? users_.attached - 1 : 0;  // ourselves
    snapshot.last_process = users_.last_process;
    snapshot.renewed = memory_->renewed();
  }
  snapshot.online = reader_ != nullptr;
  snapshot.debounce_s = seconds(options_.settings.debounce);
  footswitch::SwitchReader::Counters counters;
  if (reader_) {
    counters = reader_->counters();
    snapshot.inputs_on = reader_->inputs_on(kShownInputs);
  }
  snapshot.edges = earlier_.edges + counters.edges;
  snapshot.bounces = earlier_.bounces + counters.bounces;
  snapshot.edges_dropped = earlier_.dropped + counters.dropped;
  snapshot.waiting = scripts_.waiting();
  snapshot.scripts = scripts_.counters();
  snapshot.last = scripts_.last();
  for (const std::string& file : scripts_.missing_files()) {
    if (snapshot.missing_files.size() == kShownFiles) break;
    snapshot.missing_files.push_back(file);
  }
  snapshot.trouble = trouble_;
  snapshot.first_command = first_command_.snapshot();
  return snapshot;
}

}  // namespace cellmirror::app
