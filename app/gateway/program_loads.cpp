#include "app/gateway/program_loads.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "rt_core/base/contract.hpp"

namespace cellmirror::app {

namespace {

bool is(const LoadPicture& load, std::string_view program, std::string_view robot) {
  return load.program == program && load.robot == robot;
}

}  // namespace

Result<ActivityHandle> ProgramLoads::begin(std::string_view program, std::string_view robot,
                                           const program::Language& language, std::filesystem::path path) {
  if (loads_.size() == kMost) {
    return fail(fmt::format("{} robot programs are being loaded already", kMost), "wait until some of them are there");
  }
  const std::uint64_t id = ++last_id_;
  loads_.push_back({id, {std::string(robot), std::string(program)}, std::make_shared<Activity>(), {}});
  reader_.read(id, language, std::move(path));
  return loads_.back().activity;
}

bool ProgramLoads::under_way(std::string_view program, std::string_view robot) const {
  return std::ranges::any_of(loads_, [&](const Load& load) { return is(load.what, program, robot); });
}

// The last load that the run waits for.
std::deque<ProgramLoads::Load>::const_reverse_iterator ProgramLoads::before_run(std::string_view program,
                                                                                std::string_view robot) const {
  return std::find_if(loads_.rbegin(), loads_.rend(), [&](const Load& load) {
    return is(load.what, program, robot) || (load.what.robot == robot && !load.runs.empty());
  });
}

bool ProgramLoads::has_to_wait(std::string_view program, std::string_view robot) const {
  return before_run(program, robot) != loads_.rend();
}

Result<ActivityHandle> ProgramLoads::add_run(std::string_view program, std::string_view robot, ProgramBegin begin) {
  const auto before = before_run(program, robot);
  CELLMIRROR_EXPECTS(before != loads_.rend());
  std::vector<Run>& runs = loads_[static_cast<std::size_t>(loads_.rend() - before) - 1].runs;
  if (runs.size() == kMostRuns) {
    return fail(fmt::format("{} TF_RUN wait already until {} is loaded", kMostRuns, before->what.program));
  }
  runs.push_back({std::string(program), begin, std::make_shared<Activity>()});
  return runs.back().activity;
}

std::optional<std::vector<ProgramLoads::Run>> ProgramLoads::give_up(std::string_view program, std::string_view robot,
                                                                    const Error& why) {
  if (!under_way(program, robot)) return std::nullopt;
  std::vector<Run> others;
  for (auto load = loads_.begin(); load != loads_.end();) {
    if (!is(load->what, program, robot)) {
      ++load;
      continue;
    }
    reader_.forget(load->id);
    load->activity->refuse(why);
    for (Run& run : load->runs) {
      if (run.program == program) {
        run.activity->refuse(why);
      } else {
        others.push_back(std::move(run));
      }
    }
    load = loads_.erase(load);
  }
  return others;
}

bool ProgramLoads::give_up_runs(std::string_view robot, const Error& why) {
  bool any = false;
  for (Load& load : loads_) {
    if (load.what.robot != robot) continue;
    for (const Run& run : load.runs) run.activity->refuse(why);
    any = any || !load.runs.empty();
    load.runs.clear();
  }
  return any;
}

void ProgramLoads::give_up_all(const Error& why) {
  for (const Load& load : loads_) {
    reader_.forget(load.id);
    load.activity->refuse(why);
    for (const Run& run : load.runs) run.activity->refuse(why);
  }
  loads_.clear();
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

std::vector<LoadPicture> ProgramLoads::pictures() const {
  std::vector<LoadPicture> pictures;
  for (const Load& load : loads_) pictures.push_back(load.what);
  return pictures;
}

}  // namespace cellmirror::app
