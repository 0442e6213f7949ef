#include "tests/golden/programs/trace_run.hpp"

#include <fmt/format.h>

#include <array>
#include <map>
#include <optional>
#include <sstream>
#include <vector>

#include "scripts/programs/program/trace.hpp"

namespace cellmirror::testing {
namespace {

using namespace program;

constexpr std::array<JointKind, 6> kJoints = {JointKind::revolute,  JointKind::revolute, JointKind::revolute,
                                              JointKind::prismatic, JointKind::revolute, JointKind::revolute};
constexpr std::size_t kMostExecuted = 10'000;

// A line of inputs.txt: "[wait N] digital|analogue NUMBER on|off|VALUE".
struct InputChange {
  std::size_t wait = 0;  // 0: before the start
  bool analogue = false;
  std::size_t number = 0;
  double value = 0;
};

std::optional<std::vector<InputChange>> input_changes(std::string_view text) {
  std::vector<InputChange> changes;
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream words(line);
    InputChange change;
    std::string word;
    words >> word;
    if (word == "wait") words >> change.wait >> word;
    change.analogue = word == "analogue";
    if (!change.analogue && word != "digital") return std::nullopt;
    words >> change.number >> word;
    change.value = word == "on" ? 1 : 0;
    if (change.analogue) change.value = std::stod(word);
    if (!words || (!change.analogue && word != "on" && word != "off")) return std::nullopt;
    changes.push_back(change);
  }
  return changes;
}

class TraceWorld final : public ProgramWorld {
 public:
  TraceWorld() { X_ZT_.translation() = Eigen::Vector3d(1.0, 0.0, 0.5); }

  [[nodiscard]] JointValues joints() const override { return joints_; }
  [[nodiscard]] Result<Pose> position() const override { return X_ZT_; }
  [[nodiscard]] bool digital_input(std::size_t number) const override { return value(digital_inputs_, number) != 0; }
  [[nodiscard]] double analogue_input(std::size_t number) const override { return value(analogue_inputs_, number); }
  [[nodiscard]] bool digital_output(std::size_t number) const override { return value(digital_outputs_, number) != 0; }
  [[nodiscard]] double analogue_output(std::size_t number) const override { return value(analogue_outputs_, number); }

  void set_input(const InputChange& change) {
    (change.analogue ? analogue_inputs_ : digital_inputs_)[change.number] = change.value;
  }
  void set_output(const OutputCommand& output) {
    (output.analogue ? analogue_outputs_ : digital_outputs_)[output.number] = output.value;
  }
  void move(const Target& target) {
    switch (target.kind) {
      case TargetKind::joints_absolute:
        for (std::size_t joint = 0; joint < target.joint_count; ++joint) joints_[joint] = target.joints[joint];
        break;
      case TargetKind::joints_relative:
        for (std::size_t joint = 0; joint < target.joint_count; ++joint) joints_[joint] += target.joints[joint];
        break;
      case TargetKind::pose_absolute:
        X_ZT_ = target.pose;
        break;
      case TargetKind::pose_relative:
        X_ZT_.translation() += target.pose.translation();
        X_ZT_.linear() = target.pose.linear() * X_ZT_.linear();
        break;
      case TargetKind::tool_relative:
        X_ZT_ = X_ZT_ * target.pose;
        break;
    }
  }

 private:
  using Values = std::map<std::size_t, double>;
  static double value(const Values& values, std::size_t number) {
    const auto found = values.find(number);
    return found == values.end() ? 0 : found->second;
  }

  JointValues joints_{};
  Pose X_ZT_ = Pose::Identity();
  Values digital_inputs_;
  Values analogue_inputs_;
  Values digital_outputs_;
  Values analogue_outputs_;
};

class TraceRun {
 public:
  TraceRun(const std::shared_ptr<const Program>& program, std::vector<InputChange> changes)
      : machine_(program, kJoints), changes_(std::move(changes)) {
    change_inputs(0);
  }

  std::string run(Direction direction) {
    if (const auto set = machine_.set_direction(direction); !set) return set.error().text() + "\n";
    while (machine_.executed() < kMostExecuted) {
      switch (machine_.next(world_, kMostExecuted - machine_.executed())) {
        case Machine::Step::ended:
          return out_ + "end\n";
        case Machine::Step::failed:
          return out_ + "failed " + machine_.error().text() + "\n";
        case Machine::Step::spent:
          return out_ + "goes on\n";
        case Machine::Step::command:
          if (!carry_out(machine_.command())) return out_ + "waits for ever\n";
      }
    }
    return out_ + "goes on\n";
  }

 private:
  void change_inputs(std::size_t wait) {
    for (const InputChange& change : changes_) {
      if (change.wait == wait) world_.set_input(change);
    }
  }

  // False where the program waits for what never comes.
  bool carry_out(const CanonicalCommand& command) {
    if (std::holds_alternative<RestCommand>(command.what)) return true;
    out_ += trace_line(machine_.program(), command) + "\n";
    if (const auto* move = std::get_if<MoveCommand>(&command.what)) world_.move(move->target);
    if (const auto* output = std::get_if<OutputCommand>(&command.what)) world_.set_output(*output);
    const auto* wait = std::get_if<WaitCommand>(&command.what);
    if (wait == nullptr) return true;
    change_inputs(++waits_);
    if (machine_.holds(world_)) return true;
    if (wait->timeout_s) machine_.time_out();
    return wait->timeout_s.has_value();
  }

  TraceWorld world_;
  Machine machine_;
  std::vector<InputChange> changes_;
  std::size_t waits_ = 0;
  std::string out_;
};

}  // namespace

std::span<const JointKind> golden_joints() { return kJoints; }

std::string golden_trace(const std::shared_ptr<const Program>& program, std::string_view inputs) {
  const auto changes = input_changes(inputs);
  if (!changes) return "inputs.txt is wrong\n";
  std::string out = "program " + program->name + (program->reversible ? ", reversible\n" : "\n");
  for (const SemaphoreDeclaration& semaphore : program->semaphores) {
    out += fmt::format("semaphore {} {}\n", semaphore.name, semaphore.initial);
  }
  out += TraceRun(program, *changes).run(Direction::forward);
  if (program->reversible) out += "backward\n" + TraceRun(program, *changes).run(Direction::backward);
  return out;
}

}  // namespace cellmirror::testing
