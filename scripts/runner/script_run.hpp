// One SCRIPT file that is being executed, with the files that it has called. Private to the folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rt_core/base/diagnostics.hpp"
#include "scripts/lang/reader.hpp"
#include "scripts/runner/script_runner.hpp"

namespace cellmirror::script {

// A file on the call stack. Neither copied nor moved: the reader refers to the text.
class ScriptFile {
 public:
  ScriptFile(std::filesystem::path path, std::string name, std::string text)
      : path_(std::move(path)), name_(std::move(name)), text_(std::move(text)), reader_(text_, name_, TextKind::file) {}
  ScriptFile(const ScriptFile&) = delete;
  ScriptFile& operator=(const ScriptFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] CommandReader& reader() { return reader_; }
  [[nodiscard]] const CommandReader& reader() const { return reader_; }

 private:
  std::filesystem::path path_;  // canonical
  std::string name_;            // for diagnostics
  std::string text_;
  CommandReader reader_;
};

class ScriptRun {
 public:
  ScriptRun(std::uint64_t id, std::unique_ptr<ScriptFile> file) {
    report.id = id;
    report.file = file->name();
    stack.push_back(std::move(file));
  }
  [[nodiscard]] bool ended() const { return stack.empty(); }

  std::vector<std::unique_ptr<ScriptFile>> stack;  // the innermost last
  bool waiting = false;                            // in WAIT
  Place wait_place;
  std::uint64_t failures = 0;  // ProgramHost::failures() when the run began, or its newest WAIT ended
  ActivityHandle activity;     // not null: of the last command, which is done when this has ended
  Place activity_place;
  bool tells_later = false;  // the activity may fail later, which is reported without the run too
  Timestamp first_command;
  CommandSource::Kind from = CommandSource::Kind::file;  // who started it; file: the start, or a foot switch
  std::optional<CommandTrace> trace;                     // of the command that is under way
  RunReport report;
};

}  // namespace cellmirror::script
