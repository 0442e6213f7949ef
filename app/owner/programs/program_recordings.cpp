#include "app/owner/programs/program_recordings.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "app/owner/programs/program_files.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace {

namespace fs = std::filesystem;

std::string_view extension_of(program::TeachDialect dialect) {
  return dialect == program::TeachDialect::boom ? ".boom" : ".tarm";
}

// Under another name first: a load of the program meanwhile finds the old file or the new one, whole.
Result<void> write_teach_file(const fs::path& path, const std::string& text) {
  const fs::path temporary = path.string() + ".new";
  {
    std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
    out << text;
    out.close();
    if (!out) return fail(fmt::format("{} cannot be written: {}", temporary.string(), std::strerror(errno)));
  }
  std::error_code error;
  fs::rename(temporary, path, error);
  if (error) return fail(fmt::format("{} cannot be renamed: {}", temporary.string(), error.message()));
  return {};
}

}  // namespace

Result<void> ProgramRecordings::start(std::string_view program, std::string_view robot, std::string_view language) {
  const RobotModel* model = cell_.robot(robot);
  if (model == nullptr) return std::unexpected(cell_.explain_robot(robot));
  if (const auto found = recordings_.find(robot); found != recordings_.end()) {
    return fail(fmt::format("{} of {} is being recorded already", found->second.program, robot),
                fmt::format("end it with TF_RECORD {} {} STOP", found->second.program, robot));
  }
  const auto dialect = language == program::language_of(program::TeachDialect::tarm) ? program::TeachDialect::tarm
                                                                                     : program::TeachDialect::boom;
  auto recorder =
      program::TeachRecorder::begin(dialect, program, model->joint_kinds(), model->parameters().max_velocity);
  if (!recorder) return std::unexpected(std::move(recorder.error()));
  const auto begun = recordings_.emplace(robot, Recording{std::string(program), dialect, std::move(*recorder)}).first;
  sample(begun->first, begun->second);
  return {};
}

Result<ProgramRecordings::Recordings::iterator> ProgramRecordings::find(std::string_view program,
                                                                        std::string_view robot) {
  const auto found = recordings_.find(robot);
  if (found == recordings_.end() || found->second.program != program) {
    return fail(fmt::format("{} of {} is not being recorded", printable(program), robot),
                fmt::format("begin with TF_RECORD {} {} START", printable(program), robot));
  }
  return found;
}

Result<void> ProgramRecordings::point(std::string_view program, std::string_view robot, std::string_view name) {
  auto found = find(program, robot);
  if (!found) return std::unexpected(std::move(found.error()));
  if (!fleet_.knows_position(robot)) {
    return fail(fmt::format("the values of {} are not fresh", robot), "wait until its controller is heard again");
  }
  sample((*found)->first, (*found)->second);
  return (*found)->second.recorder.point(name);
}

Result<void> ProgramRecordings::stop(std::string_view program, std::string_view robot) {
  auto found = find(program, robot);
  if (!found) return std::unexpected(std::move(found.error()));
  Recording& recording = (*found)->second;
  const auto path = home_.file_to_write(kProgramFolder, fmt::format("{}{}", program, extension_of(recording.dialect)));
  if (!path) return std::unexpected(path.error());
  const auto text = recording.recorder.finish();
  if (!text) return std::unexpected(text.error());
  if (auto written = write_teach_file(*path, *text); !written) return written;
  recordings_.erase(*found);
  return {};
}

void ProgramRecordings::sample(std::string_view robot, Recording& recording) {
  const RobotModel* model = cell_.robot(robot);
  if (model == nullptr || !fleet_.knows_position(robot)) return;
  recording.recorder.sample(clock_.now(), fleet_.positions()[model->slot()]);
}

void ProgramRecordings::follow() {
  for (auto& [robot, recording] : recordings_) sample(robot, recording);
}

void ProgramRecordings::follow_cell() {
  std::erase_if(recordings_, [this](const auto& entry) { return cell_.robot(entry.first) == nullptr; });
}

std::vector<RecordingSnapshot> ProgramRecordings::snapshots() const {
  std::vector<RecordingSnapshot> all;
  for (const auto& [robot, recording] : recordings_) {
    all.push_back(
        {robot, recording.program, std::string(program::language_of(recording.dialect)), recording.recorder.points()});
  }
  return all;
}

}  // namespace cellmirror::app
