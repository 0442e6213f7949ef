// A machine on a robot with two joints (one turns, one slides) and what it reads from the world.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "scripts/programs/program/machine.hpp"
#include "scripts/programs/program/program_builder.hpp"
#include "scripts/programs/program/trace.hpp"

namespace cellmirror::program {

class FakeWorld final : public ProgramWorld {
 public:
  [[nodiscard]] JointValues joints() const override { return joint_values; }
  [[nodiscard]] Result<Pose> position() const override { return X_ZT; }
  [[nodiscard]] bool digital_input(std::size_t number) const override { return inputs.contains(number); }
  [[nodiscard]] double analogue_input(std::size_t number) const override { return 0.5 * static_cast<double>(number); }
  [[nodiscard]] bool digital_output(std::size_t number) const override { return outputs.contains(number); }
  [[nodiscard]] double analogue_output(std::size_t number) const override { return static_cast<double>(number); }

  JointValues joint_values{0.5, 0.25};
  Result<Pose> X_ZT = Pose::Identity();
  std::map<std::size_t, bool> inputs;
  std::map<std::size_t, bool> outputs;
};

class MachineTest : public ::testing::Test {
 protected:
  MachineTest() { builder.at(1, 1); }

  // Ends the program with errors as a failure of the test.
  Machine machine() {
    Diagnostics diagnostics;
    auto program = builder.build(diagnostics);
    EXPECT_TRUE(diagnostics.ok()) << diagnostics.text();
    const JointKind kinds[] = {JointKind::revolute, JointKind::prismatic};
    return {std::move(program), kinds};
  }
  std::string errors() {
    Diagnostics diagnostics;
    EXPECT_EQ(builder.build(diagnostics), nullptr);
    return diagnostics.text();
  }

  // All commands to the end, a line each; then how it ended.
  std::string trace(Machine& sut, std::size_t budget = 1000) {
    std::string out;
    for (std::size_t count = 0; count < 1000; ++count) {
      switch (sut.next(world, budget)) {
        case Machine::Step::command:
          out += trace_line(sut.program(), sut.command()) + "\n";
          break;
        case Machine::Step::spent:
          return out + "spent";
        case Machine::Step::ended:
          return out + "ended";
        case Machine::Step::failed:
          return out + sut.error().text();
      }
    }
    return out;
  }
  std::string run() {
    Machine sut = machine();
    return trace(sut);
  }

  // What the builder refuses is a failure of the test.
  template <class T>
  T ok(Result<T> result) {
    EXPECT_TRUE(result) << result.error().text();
    return std::move(*result);
  }
  void add(const Statement& statement) {
    const auto added = builder.add(statement);
    EXPECT_TRUE(added) << added.error().text();
  }
  ExpressionId joints(double turn, double slide) {
    const ExpressionId first = builder.real(turn);
    return ok(builder.operation(Operator::make_joints, {first, builder.real(slide)},
                                static_cast<std::uint32_t>(JointUnits::degree_mm)));
  }
  ExpressionId pose(double x, double y, double z, double roll = 0, double pitch = 0, double yaw = 0) {
    return builder.constant(pose_from_xyz_rpy({x, y, z}, {roll, pitch, yaw}));
  }
  ExpressionId input(std::int64_t number) {
    return ok(builder.operation(Operator::digital_input, {builder.integer(number)}));
  }

  ProgramBuilder builder{"sut", "test", "sut.txt"};
  FakeWorld world;
};

}  // namespace cellmirror::program
