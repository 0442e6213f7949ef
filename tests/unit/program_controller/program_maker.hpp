// Programs for tests, a statement a line.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "scripts/programs/program/program_builder.hpp"

namespace cellmirror::program::test {

class ProgramMaker {
 public:
  explicit ProgramMaker(std::string name = "p") : builder_(name, "irdata", name + ".ird") {}

  ProgramMaker& move(double target, bool fly = false) {
    const ExpressionId joints = *builder_.operation(Operator::make_joints, {builder_.real(target)});
    return add(MoveStatement{PathKind::joints, TargetKind::joints_absolute, fly, joints, kNoExpression});
  }
  ProgramMaker& fly(double target) { return move(target, true); }
  ProgramMaker& delay(double seconds) { return add(DelayStatement{builder_.real(seconds)}); }
  ProgramMaker& script(std::string_view text) { return add(ScriptStatement{builder_.text(text)}); }
  ProgramMaker& out(std::int64_t number, bool on) {
    return add(OutputStatement{false, builder_.integer(number), builder_.boolean(on)});
  }
  ProgramMaker& acquire(std::string_view name) { return add(SemaphoreStatement{true, builder_.text(name)}); }
  ProgramMaker& release(std::string_view name) { return add(SemaphoreStatement{false, builder_.text(name)}); }
  ProgramMaker& wait_for_input(std::int64_t number, std::optional<double> timeout_s = {}) {
    const ExpressionId input = *builder_.operation(Operator::digital_input, {builder_.integer(number)});
    return add(WaitStatement{input, timeout_s ? builder_.real(*timeout_s) : kNoExpression, kNone,
                             builder_.text("input " + std::to_string(number) + " is on")});
  }
  ProgramMaker& pause() { return add(PauseStatement{}); }
  ProgramMaker& tool(const Pose& X_PT) { return add(SetStatement{Setting::tool, builder_.constant(X_PT)}); }
  ProgramMaker& branch_on_output(std::int64_t number, ProgramBuilder::Label otherwise) {
    line();
    const ExpressionId output = *builder_.operation(Operator::digital_output, {builder_.integer(number)});
    check(builder_.branch_unless(output, otherwise));
    return *this;
  }
  ProgramMaker& divide_by_zero() {
    const VariableId variable = *builder_.declare("x" + std::to_string(line_), ValueType::integer);
    const ExpressionId zero = *builder_.variable(variable);
    return add(AssignStatement{variable, kNoExpression, kNone,
                               *builder_.operation(Operator::integer_divide, {builder_.integer(1), zero})});
  }
  ProgramMaker& semaphore(std::string_view name, std::uint32_t initial) {
    check(builder_.declare_semaphore(name, initial, 1));
    return *this;
  }
  ProgramMaker& reversible() {
    builder_.set_reversible();
    return *this;
  }
  ProgramBuilder::Label label() {
    const ProgramBuilder::Label here = builder_.new_label();
    builder_.bind(here);
    return here;
  }
  ProgramBuilder::Label label_ahead() { return builder_.new_label(); }
  ProgramMaker& bind(ProgramBuilder::Label ahead) {
    builder_.bind(ahead);
    return *this;
  }
  ProgramMaker& jump(ProgramBuilder::Label label) {
    line();
    builder_.jump(label);
    return *this;
  }
  std::shared_ptr<const Program> make() {
    Diagnostics findings;
    auto program = builder_.build(findings);
    EXPECT_TRUE(findings.ok()) << findings.text();
    return program;
  }

 private:
  void line() { builder_.at(++line_, 1); }
  ProgramMaker& add(const Statement& statement) {
    line();
    check(builder_.add(statement));
    return *this;
  }
  static void check(const Result<void>& done) { EXPECT_TRUE(done) << done.error().text(); }

  ProgramBuilder builder_;
  std::uint32_t line_ = 0;
};

}  // namespace cellmirror::program::test
