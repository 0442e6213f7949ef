// Teach files that are being recorded (TF_RECORD). Belongs to the thread that owns the cell.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "app/owner/fleet.hpp"
#include "app/snapshot/program_snapshot.hpp"
#include "rt_core/base/home.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/cell/cell.hpp"
#include "scripts/commands/program_host.hpp"
#include "scripts/programs/jet/teach_recorder.hpp"

namespace cellmirror::app {

class ProgramRecordings {
 public:
  // What is given outlives this.
  ProgramRecordings(const Cell& cell, const KismetHome& home, Fleet& fleet, const Clock& clock)
      : cell_(cell), home_(home), fleet_(fleet), clock_(clock) {}

  // One recording a robot. `language`: of ROBOT_LANGUAGE.
  Result<void> start(std::string_view program, std::string_view robot, std::string_view language);
  Result<void> point(std::string_view program, std::string_view robot, std::string_view name);
  // Writes the file into the home's programs/; where that fails the recording goes on.
  Result<void> stop(std::string_view program, std::string_view robot);

  // Looks where the robots are. Often. A mirrored robot's values that are not fresh are passed over.
  void follow();
  // Forgets those of robots that are gone. After every change of the tree.
  void follow_cell();
  [[nodiscard]] bool busy() const { return !recordings_.empty(); }
  [[nodiscard]] std::vector<RecordingSnapshot> snapshots() const;

 private:
  struct Recording {
    std::string program;
    program::TeachDialect dialect;
    program::TeachRecorder recorder;
  };
  using Recordings = std::map<std::string, Recording, std::less<>>;  // by robot

  Result<Recordings::iterator> find(std::string_view program, std::string_view robot);
  void sample(std::string_view robot, Recording& recording);

  const Cell& cell_;
  const KismetHome& home_;
  Fleet& fleet_;
  const Clock& clock_;
  Recordings recordings_;
};

}  // namespace cellmirror::app
