// Every statement: what comes out of the machine.
#include <numbers>

#include "tests/unit/program/machine_fixture.hpp"

namespace cellmirror::program {
namespace {

constexpr const char* kIdentity = "0.000000 0.000000 0.000000 0.000000 0.000000 0.000000 1.000000";

TEST_F(MachineTest, GivesJointMovesInRadAndMetres) {
  add(MoveStatement{.target = joints(180, 250)});
  add(MoveStatement{.kind = TargetKind::joints_relative, .fly = true, .target = joints(-90, 1)});
  EXPECT_EQ(run(), "1 move ptp to joints 3.141593 0.250000\n1 move ptp to joints+ -1.570796 0.001000 fly\nended");
}

TEST_F(MachineTest, TakesSIJointValuesAsTheyAre) {
  const ExpressionId turn = builder.real(1.5);
  add(MoveStatement{.target = ok(builder.operation(Operator::make_joints, {turn, builder.real(0.25)},
                                                   static_cast<std::uint32_t>(JointUnits::si)))});
  EXPECT_EQ(run(), "1 move ptp to joints 1.500000 0.250000\nended");
}

TEST_F(MachineTest, TurnsPosesOutOfTheZeroPoint) {
  constexpr double kQuarter = std::numbers::pi / 2;
  add(SetStatement{.setting = Setting::zero_point, .value = pose(1, 0, 0, 0, 0, kQuarter)});
  add(MoveStatement{.path = PathKind::linear, .kind = TargetKind::pose_absolute, .target = pose(0.5, 0, 0)});
  add(MoveStatement{.path = PathKind::linear, .kind = TargetKind::pose_relative, .target = pose(0.5, 0, 0, kQuarter)});
  add(MoveStatement{.path = PathKind::linear, .kind = TargetKind::tool_relative, .target = pose(0.5, 0, 0)});
  add(SetStatement{.setting = Setting::zero_point});
  add(MoveStatement{.path = PathKind::linear, .kind = TargetKind::pose_absolute, .target = pose(0.5, 0, 0)});
  EXPECT_EQ(run(),
            "1 move linear to pose 1.000000 0.500000 0.000000 0.000000 0.000000 0.707107 0.707107\n"
            "1 move linear to pose+ 0.000000 0.500000 0.000000 0.000000 0.707107 0.000000 0.707107\n"
            "1 move linear to tool+ 0.500000 0.000000 0.000000 0.000000 0.000000 0.000000 1.000000\n"
            "1 move linear to pose 0.500000 0.000000 0.000000 0.000000 0.000000 0.000000 1.000000\nended");
}

TEST_F(MachineTest, GivesTheViaPointOfAnArc) {
  const ExpressionId via = pose(1, 1, 0);
  add(MoveStatement{
      .path = PathKind::circular, .kind = TargetKind::pose_absolute, .target = pose(2, 0, 0), .via = via});
  EXPECT_EQ(run(),
            "1 move circular via pose 1.000000 1.000000 0.000000 0.000000 0.000000 0.000000 1.000000 to pose "
            "2.000000 0.000000 0.000000 0.000000 0.000000 0.000000 1.000000\nended");
}

TEST_F(MachineTest, GivesWithAMoveWhatIsSet) {
  const auto set = [&](Setting setting, double value) { add(SetStatement{setting, builder.real(value)}); };
  set(Setting::joint_velocity, 0.5);
  set(Setting::joint_acceleration, 0.25);
  set(Setting::linear_velocity, 0.1);
  set(Setting::linear_acceleration, 0.2);
  set(Setting::rotational_velocity, 0.3);
  set(Setting::rotational_acceleration, 0.4);
  set(Setting::fly_distance, 0.01);
  add(MoveStatement{.target = joints(0, 0)});
  set(Setting::fly_speed_fraction, 0.75);
  for (const Setting own : {Setting::joint_velocity, Setting::joint_acceleration, Setting::linear_velocity,
                            Setting::linear_acceleration, Setting::rotational_velocity}) {
    add(SetStatement{.setting = own});
  }
  add(MoveStatement{.target = joints(0, 0)});
  set(Setting::fly_angle, 0.125);
  add(SetStatement{.setting = Setting::rotational_acceleration});
  add(MoveStatement{.target = joints(0, 0)});
  add(SetStatement{.setting = Setting::fly_angle});
  add(MoveStatement{.target = joints(0, 0)});
  EXPECT_EQ(run(),
            "1 move ptp to joints 0.000000 0.000000 with joint_velocity 0.500000 joint_acceleration 0.250000 "
            "linear_velocity 0.100000 linear_acceleration 0.200000 rotational_velocity 0.300000 "
            "rotational_acceleration 0.400000 fly_distance 0.010000\n"
            "1 move ptp to joints 0.000000 0.000000 with rotational_acceleration 0.400000 fly_speed_fraction "
            "0.750000\n"
            "1 move ptp to joints 0.000000 0.000000 with fly_angle 0.125000\n"
            "1 move ptp to joints 0.000000 0.000000\nended");
}

TEST_F(MachineTest, GivesToolsAndTakesThemBack) {
  add(SetStatement{.setting = Setting::tool, .value = pose(0, 0, 0)});
  add(SetStatement{.setting = Setting::tool});
  EXPECT_EQ(run(), std::string("1 tool ") + kIdentity + "\n1 tool of the robot\nended");
}

TEST_F(MachineTest, GivesDelaysOutputsScriptsSemaphoresAndPauses) {
  add(DelayStatement{builder.real(2.5)});
  const ExpressionId number = builder.integer(3);
  add(OutputStatement{.number = number, .value = builder.boolean(true)});
  const ExpressionId analogue = builder.integer(2);
  add(OutputStatement{.analogue = true, .number = analogue, .value = builder.real(-0.0000001)});
  add(SemaphoreStatement{.acquire = true, .name = builder.text("S1")});
  add(SemaphoreStatement{.name = builder.text("S1")});
  add(ScriptStatement{builder.text("DRAW_SCENE")});
  add(PauseStatement{});
  EXPECT_EQ(run(),
            "1 delay 2.500000\n1 output 3 on\n1 output analogue 2 0.000000\n1 acquire S1\n1 release S1\n"
            "1 script DRAW_SCENE\n1 pause\nended");
}

TEST_F(MachineTest, LoopsWithJumpsAndBranches) {
  const VariableId count = ok(builder.declare("count", ValueType::integer, std::int64_t{3}));
  const auto begin = builder.new_label();
  const auto end = builder.new_label();
  builder.bind(begin);
  const ExpressionId left = ok(builder.variable(count));
  const ExpressionId condition = ok(builder.operation(Operator::greater, {left, builder.integer(0)}));
  EXPECT_TRUE(builder.branch_unless(condition, end));
  add(DelayStatement{ok(builder.variable(count))});
  const ExpressionId before = ok(builder.variable(count));
  add(AssignStatement{.variable = count,
                      .value = ok(builder.operation(Operator::subtract, {before, builder.integer(1)}))});
  builder.jump(begin);
  builder.bind(end);
  Machine sut = machine();
  EXPECT_EQ(trace(sut), "1 delay 3.000000\n1 delay 2.000000\n1 delay 1.000000\nended");
  EXPECT_EQ(std::get<std::int64_t>(*sut.variable("count")), 0);
  EXPECT_EQ(sut.variable("other"), nullptr);
  EXPECT_EQ(sut.position(), sut.program().statements.size());
}

TEST_F(MachineTest, CallsSubprogramsAndComesBack) {
  const auto sub = builder.new_label();
  builder.call(sub);
  builder.call(sub);
  add(EndStatement{});
  builder.bind(sub);
  add(PauseStatement{});
  add(ReturnStatement{});
  EXPECT_EQ(run(), "1 pause\n1 pause\nended");
}

TEST_F(MachineTest, EndsRecursionWithAnError) {
  const auto sub = builder.new_label();
  builder.bind(sub);
  builder.at(7, 3);
  builder.call(sub);
  EXPECT_EQ(run(),
            "sut.txt:7:3: error: more than 64 nested subprograms; a subprogram that calls itself needs a condition "
            "that ends it");
}

TEST_F(MachineTest, RefusesAReturnOutsideOfASubprogram) {
  add(ReturnStatement{});
  EXPECT_EQ(run(), "sut.txt:1:1: error: a return outside a subprogram");
}

TEST_F(MachineTest, SpendsTheBudgetOfAnEndlessLoopAndGoesOn) {
  const auto begin = builder.new_label();
  builder.bind(begin);
  builder.jump(begin);
  Machine sut = machine();
  EXPECT_EQ(trace(sut, 500), "spent");
  EXPECT_EQ(sut.executed(), 500U);
  EXPECT_EQ(trace(sut, 500), "spent");
  EXPECT_EQ(sut.executed(), 1000U);
}

TEST_F(MachineTest, AssignsElementsComponentsAndWidensIntegers) {
  const VariableId list = ok(builder.declare_list("list", ValueType::real, -1, 3));
  const VariableId place = ok(builder.declare("place", ValueType::pose));
  const VariableId angles = ok(builder.declare("angles", ValueType::joints, JointPosition{.count = 2}));
  const ExpressionId index = builder.integer(1);
  add(AssignStatement{.variable = list, .index = index, .value = builder.integer(4)});
  add(AssignStatement{.variable = place, .component = 2, .value = builder.real(0.5)});
  add(AssignStatement{.variable = place, .component = 5, .value = builder.real(std::numbers::pi)});
  add(AssignStatement{.variable = angles, .component = 1, .value = builder.integer(100)});
  add(DelayStatement{ok(builder.operation(Operator::element, {builder.integer(1)}, list))});
  add(MoveStatement{
      .path = PathKind::linear, .kind = TargetKind::pose_absolute, .target = ok(builder.variable(place))});
  add(MoveStatement{.target = ok(builder.variable(angles))});
  EXPECT_EQ(run(),
            "1 delay 4.000000\n1 move linear to pose 0.000000 0.000000 0.500000 0.000000 0.000000 1.000000 "
            "0.000000\n1 move ptp to joints 0.000000 0.100000\nended");
}

TEST_F(MachineTest, NamesTheElementsThatAListHas) {
  const VariableId list = ok(builder.declare_list("list", ValueType::real, 1, 3));
  const ExpressionId index = builder.integer(4);
  add(AssignStatement{.variable = list, .index = index, .value = builder.integer(4)});
  EXPECT_EQ(run(), "sut.txt:1:1: error: 'list' has elements 1 to 3, not 4");
}

TEST_F(MachineTest, AsksForRestBeforeItLooksAtTheWorld) {
  const VariableId here = ok(builder.declare("here", ValueType::joints));
  const ExpressionId now = ok(builder.operation(Operator::current_joints, std::span<const ExpressionId>{},
                                                static_cast<std::uint32_t>(JointUnits::degree_mm)));
  add(MoveStatement{.target = joints(0, 0)});
  add(AssignStatement{.variable = here, .value = now});
  add(MoveStatement{.target = ok(builder.variable(here))});
  world.joint_values = {std::numbers::pi, 0.25};
  EXPECT_EQ(run(), "1 move ptp to joints 0.000000 0.000000\n1 rest\n1 move ptp to joints 3.141593 0.250000\nended");
}

TEST_F(MachineTest, TellsThePositionInTheZeroPoint) {
  world.X_ZT = pose_from_xyz_rpy({3, 0, 0}, {0, 0, 0});
  add(SetStatement{.setting = Setting::zero_point, .value = pose(1, 0, 0)});
  const ExpressionId position = ok(builder.operation(Operator::current_position, std::span<const ExpressionId>{}));
  add(DelayStatement{ok(builder.operation(Operator::component, {position}, 0))});
  EXPECT_EQ(run(), "1 rest\n1 delay 2.000000\nended");
}

TEST_F(MachineTest, FailsWhereThePositionIsNotKnown) {
  world.X_ZT = fail("the robot is gone");
  const ExpressionId position = ok(builder.operation(Operator::current_position, std::span<const ExpressionId>{}));
  add(DelayStatement{ok(builder.operation(Operator::component, {position}, 0))});
  EXPECT_EQ(run(), "1 rest\nsut.txt:1:1: error: the robot is gone");
}

TEST_F(MachineTest, ReadsInputsAndOutputs) {
  world.inputs[3] = true;
  world.outputs[4] = true;
  const auto delay = [&](Operator which, std::int64_t number) {
    add(DelayStatement{ok(builder.operation(which, {builder.integer(number)}))});
  };
  const auto copy = [&](Operator which, std::int64_t number) {
    const ExpressionId to = builder.integer(number);
    add(OutputStatement{.number = to, .value = ok(builder.operation(which, {builder.integer(number)}))});
  };
  copy(Operator::digital_input, 3);
  copy(Operator::digital_input, 2);
  copy(Operator::digital_output, 4);
  delay(Operator::analogue_input, 5);
  delay(Operator::analogue_output, 6);
  EXPECT_EQ(run(),
            "1 rest\n1 output 3 on\n1 rest\n1 output 2 off\n1 rest\n1 output 4 on\n1 rest\n1 delay 2.500000\n"
            "1 rest\n1 delay 6.000000\nended");
}

TEST_F(MachineTest, RefusesPortsThatThereAreNot) {
  const VariableId port = ok(builder.declare("port", ValueType::integer, std::int64_t{0}));
  add(OutputStatement{.number = ok(builder.variable(port)), .value = builder.boolean(true)});
  EXPECT_EQ(run(), "sut.txt:1:1: error: output 0: there are outputs 1 to 1024");
}

TEST_F(MachineTest, WaitsUntilTheConditionHolds) {
  add(WaitStatement{.condition = input(3)});
  add(PauseStatement{});
  Machine sut = machine();
  ASSERT_EQ(sut.next(world, 10), Machine::Step::command);
  EXPECT_EQ(trace_line(sut.program(), sut.command()), "1 wait input 3");
  EXPECT_FALSE(sut.holds(world));
  world.inputs[3] = true;
  EXPECT_TRUE(sut.holds(world));
  EXPECT_EQ(trace(sut), "1 pause\nended");
}

TEST_F(MachineTest, FailsWhenTheTimeOfAWaitIsOver) {
  const ExpressionId condition = input(3);
  add(WaitStatement{.condition = condition, .timeout_s = builder.integer(2), .text = builder.text("the gate is open")});
  Machine sut = machine();
  ASSERT_EQ(sut.next(world, 10), Machine::Step::command);
  EXPECT_EQ(trace_line(sut.program(), sut.command()), "1 wait the gate is open, at most 2.000000");
  sut.time_out();
  EXPECT_EQ(trace(sut), "sut.txt:1:1: error: the wait timed out");
}

TEST_F(MachineTest, TellsTheProgramThatTheTimeIsOver) {
  const VariableId late = ok(builder.declare("late", ValueType::boolean, true));
  for (int count = 0; count < 2; ++count) {
    const ExpressionId condition = input(3);
    add(WaitStatement{.condition = condition, .timeout_s = builder.integer(2), .timed_out = late});
  }
  Machine sut = machine();
  ASSERT_EQ(sut.next(world, 10), Machine::Step::command);
  ASSERT_EQ(sut.next(world, 10), Machine::Step::command);
  EXPECT_FALSE(std::get<bool>(*sut.variable("late")));
  sut.time_out();
  EXPECT_EQ(sut.next(world, 10), Machine::Step::ended);
  EXPECT_TRUE(std::get<bool>(*sut.variable("late")));
}

TEST_F(MachineTest, FailsWhereAConditionCannotBeEvaluated) {
  const VariableId zero = ok(builder.declare("zero", ValueType::integer));
  const ExpressionId one = builder.integer(1);
  const ExpressionId quotient = ok(builder.operation(Operator::divide, {one, ok(builder.variable(zero))}));
  add(WaitStatement{.condition = ok(builder.operation(Operator::greater, {quotient, builder.integer(0)}))});
  Machine sut = machine();
  ASSERT_EQ(sut.next(world, 10), Machine::Step::command);
  EXPECT_TRUE(sut.holds(world));
  EXPECT_EQ(sut.next(world, 10), Machine::Step::failed);
  EXPECT_EQ(sut.error().text(), "sut.txt:1:1: error: division by 0");
  EXPECT_EQ(sut.next(world, 10), Machine::Step::failed);
}

TEST_F(MachineTest, ChecksComputedSettingsTimesAndJointCounts) {
  const VariableId value = ok(builder.declare("value", ValueType::real, 2.0));
  add(SetStatement{.setting = Setting::joint_velocity, .value = ok(builder.variable(value))});
  EXPECT_EQ(run(), "sut.txt:1:1: error: the joint velocity is 200 %: it must be above 0 and at most 100 %");
}

TEST_F(MachineTest, RefusesAComputedTimeBelowZero) {
  const VariableId value = ok(builder.declare("value", ValueType::real, -1.0));
  add(DelayStatement{ok(builder.variable(value))});
  EXPECT_EQ(run(), "sut.txt:1:1: error: the time to wait is -1 s: it must be within 0 .. 1000000 s");
}

TEST_F(MachineTest, RefusesMoreJointValuesThanTheRobotHas) {
  const VariableId where = ok(builder.declare("where", ValueType::joints, JointPosition{.count = 3}));
  add(MoveStatement{.target = ok(builder.variable(where))});
  EXPECT_EQ(run(), "sut.txt:1:1: error: 3 joint values for a robot with 2 joints");
}

TEST_F(MachineTest, RefusesToRunOtherProgramsBackward) {
  add(PauseStatement{});
  Machine sut = machine();
  EXPECT_TRUE(sut.set_direction(Direction::forward));
  EXPECT_FALSE(sut.set_direction(Direction::backward));
}

}  // namespace
}  // namespace cellmirror::program
