// Bytes become a program through ProgramBuilder, as a parser would make it, and the machine executes it in a world
// whose values come from the bytes too. Besides crashes: what the builder has accepted is found right as a whole,
// commands are finite and in their bounds, and budgets are kept.
#include <cmath>
#include <cstdint>
#include <string_view>

#include "scripts/programs/program/describe.hpp"
#include "scripts/programs/program/machine.hpp"
#include "scripts/programs/program/program_builder.hpp"
#include "scripts/programs/program/trace.hpp"
#include "tests/support/program_fuzz.hpp"

namespace {

using namespace cellmirror;
using namespace cellmirror::program;

constexpr std::array<JointKind, 3> kJoints = {JointKind::revolute, JointKind::prismatic, JointKind::continuous};

class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}
  [[nodiscard]] bool empty() const { return left_ == 0; }
  std::uint8_t next() {
    if (left_ == 0) return 0;
    --left_;
    return *data_++;
  }
  std::size_t below(std::size_t bound) { return bound == 0 ? 0 : next() % bound; }
  double number() {
    constexpr double kNumbers[] = {0, 1, -1, 0.5, 100, -0.001, 1e300, -1e300, 1e-300, 3.5};
    return kNumbers[below(std::size(kNumbers))];
  }
  std::int64_t integer() {
    constexpr std::int64_t kIntegers[] = {0, 1, 2, 3, -1, 7, 1024, 1025, INT64_MAX, INT64_MIN};
    return kIntegers[below(std::size(kIntegers))];
  }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

class World final : public ProgramWorld {
 public:
  explicit World(std::uint8_t seed) : seed_(seed) {}
  [[nodiscard]] JointValues joints() const override { return {0.1 * seed_, 0.2, 0.3}; }
  [[nodiscard]] Result<Pose> position() const override {
    if (seed_ % 16 == 0) return fail("nobody knows");
    return Pose::Identity();
  }
  [[nodiscard]] bool digital_input(std::size_t number) const override { return checked(number) % 2 == 1; }
  [[nodiscard]] double analogue_input(std::size_t number) const override {
    return static_cast<double>(checked(number));
  }
  [[nodiscard]] bool digital_output(std::size_t number) const override { return checked(number) % 2 == 0; }
  [[nodiscard]] double analogue_output(std::size_t number) const override {
    return static_cast<double>(checked(number));
  }

 private:
  [[nodiscard]] std::size_t checked(std::size_t number) const {
    require(number >= 1 && number <= kMostPorts);
    return number + seed_;
  }
  std::uint8_t seed_;
};

class Writer {
 public:
  explicit Writer(Bytes& bytes) : bytes_(bytes) {
    for (const ValueType type :
         {ValueType::boolean, ValueType::integer, ValueType::real, ValueType::pose, ValueType::joints}) {
      require(builder_.declare(name_of(type), type).has_value());
      require(builder_.declare_list("list of " + std::string(name_of(type)), type, 1, 3).has_value());
    }
    for (auto& label : labels_) label = builder_.new_label();
    if (bytes_.below(4) == 0) builder_.set_reversible();
  }

  std::shared_ptr<const Program> program() {
    for (std::uint32_t count = 0; count < 300 && !bytes_.empty(); ++count) {
      builder_.at(count + 1, 1, count % 3 == 0 ? "step" : "");
      const auto& label = labels_.at(bytes_.below(labels_.size()));
      if (bytes_.below(4) == 0 && !builder_.bound(label)) builder_.bind(label);
      statement();
    }
    for (const auto& label : labels_) {
      if (!builder_.bound(label)) builder_.bind(label);
    }
    Diagnostics diagnostics;
    auto program = builder_.build(diagnostics);
    require((program != nullptr) == diagnostics.ok());
    return program;
  }

 private:
  ExpressionId expression(int depth = 0) {
    const std::size_t kind = depth > 6 ? bytes_.below(6) : bytes_.below(12);
    switch (kind) {
      case 0:
        return builder_.boolean(bytes_.next() % 2 == 0);
      case 1:
        return builder_.integer(bytes_.integer());
      case 2:
        return builder_.real(bytes_.number());
      case 3:
        return builder_.constant(pose_from_xyz_rpy({bytes_.number(), 0, 0}, {0, 0.5, 0}));
      case 4:
        return builder_.constant(JointPosition{.values = {bytes_.number(), 1}, .count = 2});
      case 5:
        if (const auto variable = builder_.variable(static_cast<VariableId>(bytes_.below(10)))) return *variable;
        return builder_.integer(1);
      default:
        return operation(depth);
    }
  }
  ExpressionId operation(int depth) {
    const auto which = static_cast<Operator>(2 + bytes_.below(static_cast<std::size_t>(Operator::make_joints) - 1));
    const Arity arity = arity_of(which);
    std::vector<ExpressionId> operands;
    const std::size_t count = arity.least + bytes_.below(std::size_t{1} + arity.most - arity.least);
    for (std::size_t index = 0; index < count; ++index) operands.push_back(expression(depth + 1));
    const auto payload = static_cast<std::uint32_t>(bytes_.below(which == Operator::element ? 10 : 20));
    const auto made = builder_.operation(which, operands, payload);
    return made ? *made : builder_.real(2);
  }
  ExpressionId maybe() { return bytes_.below(2) == 0 ? kNoExpression : expression(); }

  void statement() {
    const auto add = [&](const Statement& statement) { static_cast<void>(builder_.add(statement)); };
    const auto label = labels_.at(bytes_.below(labels_.size()));
    switch (bytes_.below(14)) {
      case 0:
      case 1: {
        MoveStatement move{.path = static_cast<PathKind>(bytes_.below(3)),
                           .kind = static_cast<TargetKind>(bytes_.below(5)),
                           .fly = bytes_.below(2) == 0};
        move.via = maybe();
        move.target = expression();
        return add(move);
      }
      case 2: {
        AssignStatement assign{.variable = static_cast<VariableId>(bytes_.below(12))};
        assign.index = maybe();
        if (bytes_.below(2) == 0) assign.component = static_cast<std::uint32_t>(bytes_.below(20));
        assign.value = expression();
        return add(assign);
      }
      case 3:
        return builder_.jump(label);
      case 4:
        static_cast<void>(builder_.branch_unless(expression(), label));
        return;
      case 5:
        return builder_.call(label);
      case 6:
        return add(ReturnStatement{});
      case 7:
        return add(PauseStatement{});
      case 8:
        return add(DelayStatement{expression()});
      case 9: {
        WaitStatement wait{.condition = expression()};
        wait.timeout_s = maybe();
        if (bytes_.below(2) == 0) wait.timed_out = static_cast<VariableId>(bytes_.below(12));
        return add(wait);
      }
      case 10: {
        const ExpressionId number = expression();
        return add(OutputStatement{.analogue = bytes_.below(2) == 0, .number = number, .value = expression()});
      }
      case 11:
        return add(SemaphoreStatement{.acquire = bytes_.below(2) == 0, .name = builder_.text("S")});
      case 12:
        return add(ScriptStatement{builder_.text("DRAW_SCENE")});
      default:
        return add(SetStatement{static_cast<Setting>(bytes_.below(15)), maybe()});
    }
  }

  Bytes& bytes_;
  ProgramBuilder builder_{"fuzz", "fuzz", "fuzz"};
  std::array<ProgramBuilder::Label, 4> labels_;
};

void require_bounds(const Target& target) {
  require(target.joint_count <= kJoints.size());
  for (const double joint : target.joints) require(std::isfinite(joint));
  require(target.pose.matrix().allFinite());
}

void require_bounds(const CanonicalCommand& command) {
  if (const auto* move = std::get_if<MoveCommand>(&command.what)) {
    require_bounds(move->target);
    require(move->via.has_value() == (move->path == PathKind::circular));
    if (move->via) require_bounds(*move->via);
  }
  if (const auto* delay = std::get_if<DelayCommand>(&command.what)) require(delay->seconds >= 0);
  if (const auto* output = std::get_if<OutputCommand>(&command.what)) {
    require(output->number >= 1 && output->number <= kMostPorts && std::isfinite(output->value));
  }
}

void execute(const std::shared_ptr<const Program>& program, Bytes bytes) {
  Machine machine(program, kJoints);
  const World world(bytes.next());
  for (int count = 0; count < 300; ++count) {
    if (bytes.below(8) == 0) {
      static_cast<void>(machine.set_direction(bytes.below(2) == 0 ? Direction::backward : Direction::forward));
    }
    const std::uint64_t before = machine.executed();
    const Machine::Step step = machine.next(world, 20);
    require(machine.executed() <= before + 20);
    if (step == Machine::Step::failed) {
      require(!machine.error().message.empty());
      return;
    }
    if (step == Machine::Step::ended && bytes.empty()) return;
    if (step != Machine::Step::command) continue;
    require_bounds(machine.command());
    require(!trace_line(*program, machine.command()).empty());
    if (std::holds_alternative<WaitCommand>(machine.command().what) && !machine.holds(world)) machine.time_out();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  const auto program = Writer(bytes).program();
  if (program == nullptr) return 0;
  for (StatementId id = 0; id < program->statements.size(); ++id) {
    if (const auto* wait = std::get_if<WaitStatement>(&program->statements[id])) {
      require(!describe(*program, wait->condition).empty());
    }
  }
  execute(program, Bytes(data, size));
  return 0;
}
