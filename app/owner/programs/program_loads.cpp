#include "app/owner/programs/program_loads.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "rt_core/base/contract.hpp"

namespace cellmirror::app {

namespace {

bool is(const LoadSnapshot& load, std::string_view program, std::string_view robot) {
  return load.program == program && load.robot == robot;
}

// For the log, where nobody waits for an answer: without the command.
void refuse_run(const ProgramLoads::Run& run, const Error& why) {
  run.activity->refuse({fmt::format("{} was not started: {}", run.program, why.what), why.remedy});
}

}  // namespace

Result<ActivityHandle> ProgramLoads::begin(std::string_view program, std::string_view robot,
                                           const program::Language& language, std::filesystem::path path) {
  if (loads_.size() == kMost) {
    return fail(fmt::format("{} robot programs are being loaded already", kMost), "wait until some of them are there");
  }
  const std::uint64_t id = ++last_id_;
  if (auto ordered = reader_.read(id, language, std::move(path)); !ordered) return std::unexpected(ordered.error());
  loads_.push_back({id, {std::string(robot), std::string(program)}, std::make_shared<Activity>(), {}});
  return loads_.back().activity;
}

bool ProgramLoads::under_way(std::string_view program, std::string_view robot) const {
  return std::ranges::any_of(loads_, [&](const Load& load) { return is(load.what, program, robot); });
}

// The last of the first `count` loads that the run waits for.
std::optional<std::size_t> ProgramLoads::before_run(std::string_view program, std::string_view robot,
                                                    std::size_t count) const {
  for (std::size_t i = count; i > 0; --i) {
    const Load& load = loads_[i - 1];
    if (is(load.what, program, robot) || (load.what.robot == robot && !load.runs.empty())) return i - 1;
  }
  return std::nullopt;
}

bool ProgramLoads::has_to_wait(std::string_view program, std::string_view robot) const {
  return before_run(program, robot, loads_.size()).has_value();
}

Result<ActivityHandle> ProgramLoads::add_run(std::string_view program, std::string_view robot, ProgramBegin begin) {
  const auto before = before_run(program, robot, loads_.size());
  CELLMIRROR_EXPECTS(before.has_value());
  Load& load = loads_[*before];
  if (load.runs.size() == kMostRuns) {
    return fail(fmt::format("{} TF_RUN wait already until {} is loaded", kMostRuns, load.what.program));
  }
  const bool held = std::ranges::any_of(loads_, [&](const Load& other) {
    return other.what.robot == robot && !other.runs.empty() && other.runs.back().held;
  });
  load.runs.push_back({std::string(program), begin, std::make_shared<Activity>(), held});
  return load.runs.back().activity;
}

void ProgramLoads::refuse(const Load& load, const Error& why) {
  reader_.forget(load.id);
  load.activity->refuse({fmt::format("{} was not loaded: {}", load.what.program, why.what), why.remedy});
  for (const Run& run : load.runs) refuse_run(run, why);
}

std::vector<ProgramLoads::Run> ProgramLoads::cancel(std::string_view program, std::string_view robot,
                                                    const Error& why) {
  std::vector<Run> free;
  for (std::size_t i = 0; i < loads_.size();) {
    if (!is(loads_[i].what, program, robot)) {
      ++i;
      continue;
    }
    Load load = std::move(loads_[i]);
    loads_.erase(loads_.begin() + static_cast<std::ptrdiff_t>(i));
    const auto others =
        std::ranges::stable_partition(load.runs, [&](const Run& run) { return run.program == program; });
    for (Run& run : others) {
      const auto before = before_run(run.program, robot, i);
      (before ? loads_[*before].runs : free).push_back(std::move(run));
    }
    load.runs.erase(others.begin(), others.end());
    refuse(load, why);
  }
  return free;
}

bool ProgramLoads::give_up_runs(std::string_view robot, const Error& why) {
  bool any = false;
  for (Load& load : loads_) {
    if (load.what.robot != robot) continue;
    for (const Run& run : load.runs) refuse_run(run, why);
    any = any || !load.runs.empty();
    load.runs.clear();
  }
  return any;
}

// The runs of one robot wait in the order in which they came: add_run() puts none at a load before that of another.
void ProgramLoads::give_up_queued_runs(std::string_view robot, const Error& why) {
  for (Load& load : loads_) {
    if (load.what.robot != robot) continue;
    const auto first_kept =
        std::ranges::find_if(load.runs, [](const Run& run) { return run.begin != ProgramBegin::exec_wait; });
    for (auto run = load.runs.begin(); run != first_kept; ++run) refuse_run(*run, why);
    const bool all = first_kept == load.runs.end();
    load.runs.erase(load.runs.begin(), first_kept);
    if (!all) return;
  }
}

void ProgramLoads::give_up_robot(std::string_view robot, const Error& why) {
  std::erase_if(loads_, [&](const Load& load) {
    if (load.what.robot != robot) return false;
    refuse(load, why);
    return true;
  });
}

void ProgramLoads::give_up_all(const Error& why) {
  for (const Load& load : loads_) refuse(load, why);
  loads_.clear();
}

bool ProgramLoads::hold_runs(std::string_view robot, bool held) {
  bool any = false;
  for (Load& load : loads_) {
    if (load.what.robot != robot) continue;
    for (Run& run : load.runs) any = std::exchange(run.held, held) != held || any;
  }
  return any;
}

std::optional<ProgramLoads::Ended> ProgramLoads::take() {
  while (auto read = reader_.take()) {
    // Not there: it was given up while it was being read.
    const auto load = std::ranges::find(loads_, read->id, &Load::id);
    if (load == loads_.end()) continue;
    Ended ended = {std::move(load->what), std::move(load->activity), std::move(load->runs), std::move(read->text)};
    loads_.erase(load);
    return ended;
  }
  return std::nullopt;
}

bool ProgramLoads::runs_wait() const {
  return std::ranges::any_of(loads_, [](const Load& load) { return !load.runs.empty(); });
}

bool ProgramLoads::runs_wait(std::string_view robot) const {
  return std::ranges::any_of(loads_, [&](const Load& load) { return load.what.robot == robot && !load.runs.empty(); });
}

std::vector<LoadSnapshot> ProgramLoads::snapshots() const {
  std::vector<LoadSnapshot> snapshots;
  for (const Load& load : loads_) snapshots.push_back(load.what);
  return snapshots;
}

}  // namespace cellmirror::app
