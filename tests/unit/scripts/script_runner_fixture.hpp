// A script runner over files in a folder of its own, and a host that records what it is asked to do.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "rt_core/base/log.hpp"
#include "scripts/runner/script_runner.hpp"
#include "tests/golden/scripts/recording_host.hpp"

namespace cellmirror::script {

namespace fs = std::filesystem;
using Calls = std::vector<std::string>;

class ScriptRunnerTest : public ::testing::Test {
 protected:
  ScriptRunnerTest() {
    set_log_level(LogLevel::error);
    folder_ = fs::temp_directory_path() / ("cellmirror_scripts_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "scripts");
    home_.emplace(KismetHome::open(folder_).value());
    sut_.emplace(gateway_.host(), *home_, clock_,
                 ScriptRunner::Events{.run_ended = [this](const RunReport& report) { run_ended(report); },
                                      .refused = [this](const Diagnostics& findings) { refused_.take(findings); },
                                      .all_stopped = [this] { ++times_all_stopped_; }});
  }
  ~ScriptRunnerTest() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / "scripts" / name, std::ios::binary) << text;
  }
  void run_all() {
    while (sut_->step(1000) != 0) {
    }
  }
  void run_ended(const RunReport& report) {
    reports_.push_back(report);
    if (report.file == start_when_ended_.first) {
      EXPECT_TRUE(sut_->start_file(start_when_ended_.second));
    }
  }

  fs::path folder_;
  std::optional<KismetHome> home_;
  ManualClock clock_;
  cellmirror::testing::RecordingHost gateway_;
  std::optional<ScriptRunner> sut_;
  std::vector<RunReport> reports_;
  Diagnostics refused_;
  int times_all_stopped_ = 0;
  std::pair<std::string, std::string> start_when_ended_;  // a file, and the one that is started when it has ended
};

}  // namespace cellmirror::script
