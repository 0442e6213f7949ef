// What the inputs of an I/O node are.
#include "app/workers/io_inputs.hpp"

#include <gtest/gtest.h>

namespace cellmirror::app {
namespace {

struct IoInputsTest : testing::Test {
  IoInputsTest() {
    RobotSnapshot robot;
    robot.id = "ARM";
    robot.slot = 1;
    cell_state.robots = {robot};
    tick.robots[1].joint_count = 2;
    node.inputs = {{.bit = 0, .source = BarrierInput{"gate"}, .inverted = false},
                   {.bit = 5, .source = JointInput{"ARM", 1, 0.5, true}, .inverted = false},
                   {.bit = 31, .source = JointInput{"ARM", 1, 0.5, false}, .inverted = true}};
    node.analogues = {{.channel = 2, .sensor = "Echo", .full_scale = 2}};
  }
  IoInputs inputs(const RangeReadings* readings) { return io_inputs(node, cell_state, tick, readings); }

  CellState cell_state;
  engine::TickState tick{2};
  RangeReadings ranges;
  IoNodeConfig node;
};

TEST_F(IoInputsTest, BarriersJointsAndSensors) {
  BarrierReading gate;
  gate.name = "gate";
  ranges.barriers.push_back(gate);
  RangeReading echo;
  echo.id = "Echo";
  echo.distance_m = 0.5;
  ranges.readings.push_back(echo);
  tick.robots[1].joints[1].position = 0.4;
  EXPECT_EQ(inputs(&ranges).digital, 0U) << "the inverted one is on below";
  EXPECT_EQ(inputs(&ranges).analogue[2], 8192);
  ranges.barriers[0].interrupted = true;
  tick.robots[1].joints[1].position = 0.6;
  EXPECT_EQ(inputs(&ranges).digital, 0x80000021U);
  ranges.readings[0].distance_m = 5;
  EXPECT_EQ(inputs(&ranges).analogue[2], 32767);
  ranges.readings[0].distance_m.reset();
  EXPECT_EQ(inputs(&ranges).analogue[2], 32767) << "no echo";
}

TEST_F(IoInputsTest, WhatIsNotKnown) {
  cell_state.robots.clear();
  EXPECT_EQ(inputs(nullptr).digital, 0x80000001U) << "the beam counts as interrupted";
  EXPECT_EQ(inputs(nullptr).analogue[2], 32767);
  EXPECT_EQ(inputs(&ranges).digital, 0x80000001U);
}

}  // namespace
}  // namespace cellmirror::app
