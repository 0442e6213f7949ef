// What the builder folds, refuses and reports.
#include "scripts/programs/program/describe.hpp"
#include "tests/unit/program/machine_fixture.hpp"

namespace cellmirror::program {
namespace {

TEST_F(MachineTest, FoldsWhatIsConstant) {
  const ExpressionId two = builder.integer(2);
  const ExpressionId sum = ok(builder.operation(Operator::add, {two, builder.integer(3)}));
  const ExpressionId doubled = ok(builder.operation(Operator::multiply, {sum, builder.real(1.5)}));
  ASSERT_NE(builder.constant_value(doubled), nullptr);
  EXPECT_EQ(std::get<double>(*builder.constant_value(doubled)), 7.5);
  add(DelayStatement{doubled});
  Machine sut = machine();
  EXPECT_EQ(sut.program().constants.size(), 1U);
  EXPECT_EQ(sut.program().expressions.size(), 1U);
}

TEST_F(MachineTest, RefusesConstantsThatCannotBeComputed) {
  const ExpressionId one = builder.integer(1);
  const auto quotient = builder.operation(Operator::divide, {one, builder.integer(0)});
  ASSERT_FALSE(quotient);
  EXPECT_EQ(quotient.error().text(), "division by 0; change the values");
}

TEST_F(MachineTest, RefusesWrongTypesWithTheirNames) {
  const ExpressionId one = builder.integer(1);
  const auto sum = builder.operation(Operator::add, {one, builder.boolean(true)});
  ASSERT_FALSE(sum);
  EXPECT_EQ(sum.error().text(), "'+' takes numbers, not an integer and a boolean");
  EXPECT_FALSE(builder.add(DelayStatement{builder.boolean(true)}));
  EXPECT_FALSE(builder.add(DelayStatement{}));
  EXPECT_FALSE(builder.add(DelayStatement{builder.real(-1)}));
  EXPECT_FALSE(builder.add(MoveStatement{.target = builder.real(1)}));
  EXPECT_FALSE(builder.add(MoveStatement{.kind = TargetKind::pose_absolute, .target = joints(1, 2)}));
  EXPECT_FALSE(builder.add(SetStatement{.setting = Setting::linear_velocity, .value = builder.real(0)}));
  EXPECT_FALSE(builder.add(SetStatement{.setting = Setting::tool, .value = builder.real(0)}));
  EXPECT_FALSE(builder.add(SemaphoreStatement{}));
  EXPECT_FALSE(builder.add(ScriptStatement{}));
  EXPECT_FALSE(builder.branch_unless(builder.integer(1), builder.new_label()));
  const ExpressionId port = builder.integer(1025);
  EXPECT_FALSE(builder.add(OutputStatement{.number = port, .value = builder.boolean(true)}));
}

TEST_F(MachineTest, RefusesAnArcWithoutItsViaPoint) {
  EXPECT_FALSE(builder.add(
      MoveStatement{.path = PathKind::circular, .kind = TargetKind::pose_absolute, .target = pose(0, 0, 0)}));
}

TEST_F(MachineTest, RefusesDeclarationsThatDoNotFit) {
  EXPECT_TRUE(builder.declare("a", ValueType::real, std::int64_t{1}));
  EXPECT_FALSE(builder.declare("a", ValueType::real));
  EXPECT_FALSE(builder.declare("b", ValueType::integer, 1.0));
  EXPECT_FALSE(builder.declare_list("c", ValueType::integer, 1, 0));
  EXPECT_FALSE(builder.declare_list("c", ValueType::integer, 1, kMostListElements + 1));
  EXPECT_FALSE(builder.declare_list("c", ValueType::integer, 1, 2, {1.0}));
  EXPECT_TRUE(builder.declare_list("c", ValueType::real, 1, kMostListElements, {std::int64_t{7}}));
  EXPECT_FALSE(builder.declare_list("d", ValueType::real, 1, 1)) << "the first list has taken all elements";
  EXPECT_EQ(builder.find_variable("c"), 1U);
  EXPECT_FALSE(builder.find_variable("C"));
  EXPECT_FALSE(builder.variable(1)) << "a list needs an index";
  EXPECT_FALSE(builder.operation(Operator::element, {builder.integer(1)}, 0)) << "no list";
}

TEST_F(MachineTest, RefusesToNestTooDeep) {
  const VariableId a = ok(builder.declare("a", ValueType::real));
  ExpressionId deep = ok(builder.variable(a));
  for (std::size_t depth = 1; depth < kMostExpressionDepth; ++depth) {
    deep = ok(builder.operation(Operator::negate, {deep}));
  }
  EXPECT_FALSE(builder.operation(Operator::negate, {deep}));
}

TEST_F(MachineTest, ReportsJumpsToNowhere) {
  builder.at(4, 2);
  builder.jump(builder.new_label());
  EXPECT_EQ(errors(), "sut.txt:4:2: error: the target of the jump is not in the program\n");
}

TEST_F(MachineTest, TakesALabelBehindTheLastStatement) {
  const auto end = builder.new_label();
  builder.jump(end);
  add(PauseStatement{});
  builder.bind(end);
  EXPECT_EQ(run(), "ended");
}

TEST_F(MachineTest, KnowsItsSemaphores) {
  EXPECT_TRUE(builder.declare_semaphore("S", 1, 3));
  EXPECT_TRUE(builder.declare_semaphore("S", 1, 4));
  EXPECT_FALSE(builder.declare_semaphore("S", 2, 5));
  add(SemaphoreStatement{.acquire = true, .name = builder.text("S")});
  add(SemaphoreStatement{.name = builder.text("T")});
  Machine sut = machine();
  EXPECT_FALSE(sut.program().releases("S"));
  EXPECT_TRUE(sut.program().releases("T"));
  ASSERT_EQ(sut.program().semaphores.size(), 1U);
}

TEST_F(MachineTest, NamesItsSteps) {
  builder.at(5, 1, "N40");
  add(PauseStatement{});
  builder.at(6, 1);
  add(PauseStatement{});
  Machine sut = machine();
  EXPECT_EQ(sut.program().step_name(0), "N40");
  EXPECT_EQ(sut.program().step_name(1), "line 6");
  EXPECT_EQ(sut.program().step_name(2), "end");
}

TEST_F(MachineTest, ReportsMovesWithMoreJointsThanTheRobotHas) {
  add(MoveStatement{.target = joints(0, 0)});
  Machine sut = machine();
  const JointKind kinds[] = {JointKind::revolute, JointKind::revolute};
  Diagnostics diagnostics;
  sut.program().check_for(kinds, diagnostics);
  EXPECT_TRUE(diagnostics.ok());
  sut.program().check_for(std::span(kinds).first(1), diagnostics);
  EXPECT_EQ(diagnostics.text(), "sut.txt:1:1: error: the move has 2 joint values, the robot has 1 joints\n");
}

TEST_F(MachineTest, DescribesConditions) {
  const VariableId a = ok(builder.declare("A", ValueType::integer));
  const VariableId list = ok(builder.declare_list("L", ValueType::real, 1, 3));
  const ExpressionId left = ok(builder.variable(a));
  const ExpressionId sum = ok(builder.operation(Operator::add, {left, builder.integer(1)}));
  const ExpressionId element = ok(builder.operation(Operator::element, {builder.integer(2)}, list));
  const ExpressionId root = ok(builder.operation(Operator::square_root, {element}));
  const ExpressionId greater = ok(builder.operation(Operator::greater, {sum, root}));
  const ExpressionId closed = ok(builder.operation(Operator::logical_not, {input(3)}));
  const ExpressionId both = ok(builder.operation(Operator::logical_and, {greater, closed}));
  add(WaitStatement{.condition = both});
  Machine sut = machine();
  EXPECT_EQ(describe(sut.program(), both), "((A + 1) > sqrt(L[2])) and not input 3");
}

// What a parser that fills the arrays itself may get wrong.
TEST(CheckProgram, ReportsBrokenIndices) {
  const auto broken = [](auto&& spoil) {
    Program program;
    program.expressions = {{.which = Operator::constant}, {.which = Operator::negate, .operands = 1}};
    program.operands = {0};
    program.constants = {1.0};
    program.statements = {DelayStatement{1}};
    program.places = {{}};
    spoil(program);
    Diagnostics diagnostics;
    check_program(program, diagnostics);
    return !diagnostics.ok();
  };
  EXPECT_FALSE(broken([](Program&) {}));
  EXPECT_TRUE(broken([](Program& program) { program.operands = {1}; })) << "an operand that is its own operator";
  EXPECT_TRUE(broken([](Program& program) { program.operands = {}; }));
  EXPECT_TRUE(broken([](Program& program) { program.constants = {}; }));
  EXPECT_TRUE(broken([](Program& program) { program.places = {}; }));
  EXPECT_TRUE(broken([](Program& program) { program.statements = {DelayStatement{2}}; }));
  EXPECT_TRUE(broken([](Program& program) { program.statements = {JumpStatement{2}}; }));
  EXPECT_TRUE(broken([](Program& program) { program.statements = {ScriptStatement{0}}; }));
  EXPECT_TRUE(broken([](Program& program) { program.statements = {AssignStatement{.value = 0}}; }));
  EXPECT_TRUE(broken([](Program& program) { program.variables.resize(1); })) << "no initial value";
}

}  // namespace
}  // namespace cellmirror::program
