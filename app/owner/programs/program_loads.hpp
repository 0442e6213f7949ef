// Programs that are being loaded, and what waits for them. Belongs to the thread that owns the cell.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/owner/programs/program_reader.hpp"
#include "app/snapshot/program_snapshot.hpp"
#include "scripts/commands/program_host.hpp"

namespace cellmirror::app {

class ProgramLoads {
 public:
  static constexpr std::size_t kMost = 64;      // under way
  static constexpr std::size_t kMostRuns = 64;  // that wait for one of them

  // A TF_RUN that came while its program was being loaded, or behind such a one of the same robot.
  struct Run {
    std::string program;
    ProgramBegin begin = ProgramBegin::now;
    std::shared_ptr<Activity> activity;
    bool held = false;  // TF_HOLD came before it could begin
  };
  struct Ended {
    LoadSnapshot what;
    std::shared_ptr<Activity> activity;
    std::vector<Run> runs;
    ProgramText text;
  };

  explicit ProgramLoads(ProgramReader::Reading reading) : reader_(std::move(reading)) {}

  // Refused: kMost are under way, or the system gives no thread.
  Result<ActivityHandle> begin(std::string_view program, std::string_view robot, const program::Language& language,
                               std::filesystem::path path);
  [[nodiscard]] bool under_way(std::string_view program, std::string_view robot) const;
  // A run of that program waits: it is being loaded, or runs of that robot wait before it.
  [[nodiscard]] bool has_to_wait(std::string_view program, std::string_view robot) const;
  // Of a run that has to wait. Refused: kMostRuns wait for that load.
  Result<ActivityHandle> add_run(std::string_view program, std::string_view robot, ProgramBegin begin);
  // Loads of that name, and runs that wait for them, are refused with that reason. Runs of other programs that waited
  // behind these keep their places behind loads that came before; returns those that need not wait any longer.
  std::vector<Run> cancel(std::string_view program, std::string_view robot, const Error& why);
  bool give_up_runs(std::string_view robot, const Error& why);  // false: none waits
  // Those that would begin behind what the robot runs now, which has failed: exec_wait, up to the first without.
  void give_up_queued_runs(std::string_view robot, const Error& why);
  void give_up_robot(std::string_view robot, const Error& why);  // its loads and runs
  void give_up_all(const Error& why);
  // Whether the runs of the robot that wait begin held. False: they would have anyway.
  bool hold_runs(std::string_view robot, bool held);
  // The next that has been read; the caller ends its activities. In the order in which they began.
  [[nodiscard]] std::optional<Ended> take();

  [[nodiscard]] bool empty() const { return loads_.empty(); }
  [[nodiscard]] bool runs_wait() const;
  [[nodiscard]] bool runs_wait(std::string_view robot) const;
  [[nodiscard]] std::vector<LoadSnapshot> snapshots() const;

 private:
  struct Load {
    std::uint64_t id = 0;
    LoadSnapshot what;
    std::shared_ptr<Activity> activity;
    std::vector<Run> runs;
  };
  void refuse(const Load& load, const Error& why);
  [[nodiscard]] std::optional<std::size_t> before_run(std::string_view program, std::string_view robot,
                                                      std::size_t count) const;

  std::deque<Load> loads_;
  std::uint64_t last_id_ = 0;
  ProgramReader reader_;
};

}  // namespace cellmirror::app
