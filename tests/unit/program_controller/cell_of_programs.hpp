// Controllers with fake robots A, B, ... and a clock that ticks every millisecond.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scripts/programs/controller/controllers.hpp"
#include "tests/unit/program_controller/fake_motion.hpp"
#include "tests/unit/program_controller/program_maker.hpp"

namespace cellmirror::program::test {

class FakeScripts final : public ProgramScripts {
 public:
  Result<ActivityHandle> execute(std::string_view text, std::string_view source) override {
    sources.emplace_back(source);
    return answer ? answer(text) : Result<ActivityHandle>(nullptr);
  }
  std::function<Result<ActivityHandle>(std::string_view text)> answer;
  std::vector<std::string> sources;
};

class CellOfPrograms {
 public:
  CellOfPrograms() {
    clock.set(Timestamp{kStart});
    for (const char* id : {"A", "B", "C"}) motion.robot(id);
    sut.on_event([this](const ProgramEvent& event) { events.push_back(event); });
  }

  void load(std::string_view robot, std::string_view name, ProgramMaker& maker) {
    const auto loaded = sut.load(robot, name, maker.make());
    ASSERT_TRUE(loaded) << loaded.error().text();
  }
  void run(std::string_view robot, std::string_view name, Direction direction = Direction::forward) {
    const auto begun = sut.run(robot, name, Controllers::Begin::now, direction);
    ASSERT_TRUE(begun) << begun.error().text();
  }
  // The owner looks every `look` milliseconds.
  void pass(double duration_s) {
    const auto ticks = std::llround(duration_s * 1000);
    for (long long i = 0; i < ticks; ++i) {
      clock.advance(Nanoseconds(1'000'000));
      motion.advance(0.001);
      if (++tick_ % look == 0) sut.follow();
    }
  }
  // Until no program is busy, at most `most_s`.
  void finish(double most_s = 60) {
    for (double passed = 0; sut.busy() && passed < most_s; passed += 0.01) pass(0.01);
    EXPECT_FALSE(sut.busy());
  }

  [[nodiscard]] double now_s() const { return static_cast<double>(clock.now().ns - kStart) * 1e-9; }
  [[nodiscard]] double q(std::string_view robot) { return motion.robot(robot).q; }
  [[nodiscard]] ProgramStatus status(std::string_view robot, std::string_view name) const {
    for (const ProgramStatus& status : sut.status()) {
      if (status.robot == robot && status.name == name) return status;
    }
    ADD_FAILURE() << name << " is not loaded";
    return {};
  }
  // Seconds after the start; of the first one; -1: none.
  [[nodiscard]] double time_of(ProgramEvent::Kind kind, std::string_view program, std::string_view part = {}) const {
    for (const ProgramEvent& event : events) {
      if (event.kind != kind || event.program != program || event.text.find(part) == std::string::npos) continue;
      return static_cast<double>(event.time.ns - kStart) * 1e-9;
    }
    return -1;
  }
  [[nodiscard]] std::vector<std::string> texts(ProgramEvent::Kind kind, std::string_view program) const {
    std::vector<std::string> texts;
    for (const ProgramEvent& event : events) {
      if (event.kind == kind && event.program == program) texts.push_back(event.text);
    }
    return texts;
  }

  static constexpr std::int64_t kStart = 1'000'000'000;
  int look = 1;
  ManualClock clock;
  FakeMotion motion{clock};
  FakeScripts scripts;
  Controllers sut{motion, scripts, clock};
  std::vector<ProgramEvent> events;

 private:
  long long tick_ = 0;
};

}  // namespace cellmirror::program::test
