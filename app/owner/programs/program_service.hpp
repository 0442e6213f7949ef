// Robot programs of the running cell: what SCRIPT asks for them, and what they ask of SCRIPT. Owns the virtual
// controllers. Belongs to the thread that owns the cell. docs/robot-programs.md.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/owner/display/display_service.hpp"
#include "app/owner/fleet.hpp"
#include "app/owner/motion/motion_service.hpp"
#include "app/owner/programs/program_loads.hpp"
#include "app/owner/programs/program_recordings.hpp"
#include "app/snapshot/program_snapshot.hpp"
#include "rt_core/base/home.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/cell/cell.hpp"
#include "scripts/commands/program_host.hpp"
#include "scripts/programs/controller/controllers.hpp"
#include "scripts/programs/controller/program_motion.hpp"
#include "scripts/runner/script_runner.hpp"

namespace cellmirror::app {

class ProgramService final : public ProgramHost, public program::ProgramScripts {
 public:
  static constexpr std::size_t kMostAwaiting = 256;  // TF_WAIT at a time
  static constexpr std::size_t kKeptFailures = 16;

  // What is referred to outlives the service.
  struct Parts {
    const Cell& cell;
    const KismetHome& home;
    Fleet& fleet;
    const MotionService& motion;
    const DisplayService& display;
    program::ProgramMotion& moves;
    const Clock& clock;
    // Executes the SCRIPT commands of programs. Asked then: the runner hands commands to this service, so it is made
    // later. Empty: programs have none.
    std::function<script::ScriptRunner&()> runner = {};
    std::function<void(const program::ProgramEvent&)> event = {};  // with all that happens
    // Long programs are read in a thread of their own. Not off line, where no time passes meanwhile.
    bool read_aside = false;
  };
  explicit ProgramService(Parts parts);

  Result<void> set_language(std::string_view language) override;
  Result<ActivityHandle> load_program(std::string_view program, std::string_view robot) override;
  Result<ActivityHandle> run_program(std::string_view program, std::string_view robot, ProgramBegin begin) override;
  Result<void> delete_program(std::string_view program, std::string_view robot) override;
  Result<void> hold_program(std::string_view robot) override;
  Result<void> resume_program(std::string_view robot) override;
  Result<void> step_program(std::string_view robot, bool backward) override;
  Result<void> stop_programs(std::string_view robot) override;
  Result<ActivityHandle> await_programs(std::string_view robot) override;
  Result<void> record_program(std::string_view program, std::string_view robot, RecordStep step,
                              std::string_view point) override;
  Result<void> set_digital_input(std::string_view robot, std::size_t number, bool on) override;
  Result<void> set_analogue_input(std::string_view robot, std::size_t number, double value) override;
  [[nodiscard]] bool busy() const override;
  [[nodiscard]] std::uint64_t failures() const override { return failures_; }
  [[nodiscard]] Result<void> verdict(std::uint64_t since) const override;

  // For the virtual controllers: one command of a program.
  Result<ActivityHandle> execute(std::string_view text, std::string_view source) override;

  // Lets programs go on. Often; between the commands of SCRIPT, never within one. True where anything did.
  bool follow();
  // A program, a recording or a load needs follow() soon.
  [[nodiscard]] bool needs_turns() const { return controllers_.busy() || recordings_.busy() || !loads_.empty(); }
  // After every change of the tree: the programs of robots that are gone end and are forgotten, those that are being
  // loaded too, so that they do not run on a robot that gets the same name later.
  void follow_cell();
  // The robot takes no motion commands any more: what it runs fails with this reason.
  void cancel(std::string_view robot, const Error& why);
  // TF_RUN that waits until its program is loaded is refused with this reason.
  void give_up_waiting(std::string_view robot, const Error& why) { loads_.give_up_runs(robot, why); }
  // All programs end; waiters are refused.
  void shut_down();

  // The program that moves the robot now; empty: none.
  [[nodiscard]] std::string moving_program(std::string_view robot) const;
  [[nodiscard]] const program::Controllers& controllers() const { return controllers_; }
  [[nodiscard]] const std::string& language() const { return language_; }
  [[nodiscard]] ProgramsSnapshot snapshot() const;

 private:
  struct Awaiting {
    std::string robot;
    std::shared_ptr<Activity> activity;
  };

  Result<void> accept(std::string_view program, std::string_view robot, ProgramText text);
  Result<void> begin_run(std::string_view program, std::string_view robot, ProgramBegin begin);
  void begin_waiting_run(const ProgramLoads::Run& run, std::string_view robot);
  bool end_loads();
  void note(const program::ProgramEvent& event);
  void answer_awaiting();
  [[nodiscard]] SignalSnapshot signals_of(const RobotModel& robot) const;
  // Refused: the cell has no such robot.
  [[nodiscard]] Result<void> check_robot(std::string_view robot) const;
  [[nodiscard]] bool loaded(std::string_view program, std::string_view robot) const;

  Parts parts_;
  program::Controllers controllers_;
  ProgramRecordings recordings_;
  ProgramLoads loads_;
  std::string language_ = "irdata";  // manual 1.2.1
  std::uint64_t failures_ = 0;
  std::deque<std::string> failed_;  // why, the newest last
  // By robot: what failed first since its programs were last begun.
  std::map<std::string, std::string, std::less<>> failed_of_robot_;
  std::vector<Awaiting> awaiting_;
};

}  // namespace cellmirror::app
