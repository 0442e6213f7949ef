// SCRIPT texts to a TissueService in a small cell with two instruments, and what arrives at the simulation.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/owner/hosts.hpp"
#include "app/owner/tissue/tissue_service.hpp"
#include "config/cell_file.hpp"
#include "scripts/commands/execute.hpp"
#include "scripts/lang/reader.hpp"
#include "tests/golden/scripts/quiet_host.hpp"

namespace cellmirror::app {

struct RecordingPort final : TissuePort {
  Result<void> request(std::vector<tissue::Command> commands) override {
    if (full) return fail("the queue of the simulation of tissue is full", "send fewer commands at a time");
    ++requests;
    for (tissue::Command& command : commands) taken.push_back(std::move(command));
    return {};
  }
  std::vector<tissue::Command> taken;
  std::size_t requests = 0;
  bool full = false;
};

inline TissueObject object_named(std::string name) { return {.name = std::move(name)}; }

// Nothing of what the answer says; the command was refused.
struct Answer {
  bool done = false;
  std::string text;  // remark, or what and remedy
};

class TissueDesk : public ::testing::Test {
 protected:
  static constexpr std::string_view kInstrument = R"(
format = 1
description = "an instrument"
geometry = [{ name = "sleeve", cylinder_m = [0.004, 0.01] }]
[[node]]
name = "TURN"
joint = { type = "continuous", axis = [0, 0, 1], velocity_rad_s = 5.0 }
[[node]]
name = "SLIDE"
parent = "TURN"
geometry = [{ name = "shaft", cylinder_m = [0.0025, 0.3] }]
joint = { type = "prismatic", axis = [0, 0, 1], range_m = [0.03, 0.26], velocity_m_s = 1.0, start_m = 0.1 }
[[node]]
name = "JAW"
parent = "SLIDE"
geometry = [{ name = "upper_jaw", cylinder_m = [0.00125, 0.0155] }, { name = "lower jaw", cylinder_m = [0.00125, 0.0155] }]
joint = { type = "revolute", axis = [1, 0, 0], range_rad = [0.0, 0.55], velocity_rad_s = 5.0 }
[[node]]
name = "TIP"
parent = "SLIDE"
[robot]
id = "INSTRUMENT"
flange = "TIP"
)";
  static constexpr std::string_view kCell = R"(
format = 1
name = "small"
[[node]]
name = "Left"
abstract = "instrument.mpc"
robot_id = "LEFT"
[[node]]
name = "Right"
abstract = "instrument.mpc"
robot_id = "RIGHT"
[[node]]
name = "Table"
geometry = [{ name = "plate", box_m = [0.3, 0.2, 0.01] }]
)";

  void SetUp() override {
    folder_ =
        std::filesystem::path(::testing::TempDir()) / ("tissue_desk_" + std::to_string(::getpid()) + "_" +
                                                       ::testing::UnitTest::GetInstance()->current_test_info()->name());
    write("cell.toml", kCell);
    write("envlib/instrument.mpc", kInstrument);
    Diagnostics diagnostics;
    auto loaded = load_cell(folder_ / "cell.toml", diagnostics);
    ASSERT_TRUE(loaded) << diagnostics.text();
    cell_.emplace(std::move(loaded->cell));
    names_.emplace(*cell_);
    names_->set_active("LEFT");
    use({object_named("liver.mpo"), object_named("gallbladder.mpo")});
  }
  void TearDown() override {
    std::error_code error;
    std::filesystem::remove_all(folder_, error);
  }

  void write(const std::filesystem::path& file, std::string_view text) const {
    std::filesystem::create_directories((folder_ / file).parent_path());
    std::ofstream(folder_ / file, std::ios::binary) << text;
  }

  // A service for these objects, before which nothing happened.
  void use(std::vector<TissueObject> objects, bool with_port = true) {
    port_ = {};
    sut_.emplace(*cell_, *names_,
                 TissueParts{.objects = std::move(objects),
                             .hyper_file = {},
                             .readers = {.hyper = [this](const auto& file) { return read_hyper(file); },
                                         .clip = [this](const auto& file) { return read_clip(file); }},
                             .port = with_port ? &port_ : nullptr});
  }

  // One command of SCRIPT, as a message.
  Answer send(const std::string& text) {
    CommandHost host{*names_, quiet_, quiet_, quiet_, quiet_, quiet_, quiet_, quiet_, *sut_, quiet_, quiet_};
    Diagnostics findings;
    script::ParsedCommand command;
    script::CommandReader reader(text, "message", script::TextKind::message);
    if (reader.next(&*names_, command, findings) != script::CommandReader::Step::command)
      return {false, findings.text()};
    script::Outcome outcome = script::execute(command, host);
    if (outcome.kind == script::Outcome::Kind::refused) return {false, outcome.error.text()};
    return {outcome.kind == script::Outcome::Kind::done, outcome.remark};
  }
  // A command that is done without a remark.
  void do_it(const std::string& text) {
    const Answer answer = send(text);
    EXPECT_TRUE(answer.done) << text << ": " << answer.text;
    EXPECT_EQ(answer.text, "") << text;
  }

  // The newest command of the simulation.
  template <class Command>
  const Command& last() const {
    static const Command none{};
    const Command* command = port_.taken.empty() ? nullptr : std::get_if<Command>(&port_.taken.back());
    EXPECT_NE(command, nullptr);
    return command == nullptr ? none : *command;
  }
  [[nodiscard]] const TissueSettings& settings() const { return *sut_->settings(); }
  [[nodiscard]] std::size_t slot(std::string_view robot) const { return cell_->robot(robot)->slot(); }

  // What the readers give, and what they were asked for.
  Result<tissue::HyperDescription> read_hyper(std::string_view file) {
    read_ = file;
    if (!hyper_) return std::unexpected(hyper_.error());
    return tissue::HyperDescription{.file = read_, .connections = *hyper_};
  }
  Result<tissue::ClipDefinition> read_clip(std::string_view file) {
    read_ = file;
    return clip_;
  }

  std::filesystem::path folder_;
  std::optional<Cell> cell_;
  std::optional<CellNames> names_;
  RecordingPort port_;
  testing::QuietHost quiet_;
  std::optional<TissueService> sut_;
  Result<std::vector<tissue::Connection>> hyper_;
  Result<tissue::ClipDefinition> clip_ = tissue::ClipDefinition{.name = "clip", .shape = {}};
  std::string read_;
};

}  // namespace cellmirror::app
