#include "scripts/programs/program/program.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace cellmirror::program {
namespace {

// How many joints an expression has for certain; 0 where that shows only when it is evaluated.
std::size_t joint_count(const Program& program, ExpressionId id) {
  if (id >= program.expressions.size()) return 0;
  const ExpressionNode& node = program.expressions[id];
  if (node.which == Operator::make_joints) return node.operands;
  if (node.which != Operator::constant) return 0;
  const auto* joints = std::get_if<JointPosition>(&program.constants[node.payload]);
  return joints == nullptr ? 0 : joints->count;
}

}  // namespace

void Program::check_for(std::span<const JointKind> joints, Diagnostics& diagnostics) const {
  for (StatementId id = 0; id < statements.size(); ++id) {
    const auto* move = std::get_if<MoveStatement>(&statements[id]);
    if (move == nullptr) continue;
    const std::size_t count = std::max(joint_count(*this, move->target), joint_count(*this, move->via));
    if (count > joints.size()) {
      diagnostics.error(place(id),
                        fmt::format("the move has {} joint values, the robot has {} joints", count, joints.size()));
    }
  }
}

Place Program::place(StatementId statement) const {
  Place place{.file = file};
  if (statement < places.size()) {
    place.line = static_cast<int>(places[statement].line);
    place.column = places[statement].column;
  }
  return place;
}

std::string Program::step_name(StatementId statement) const {
  if (statement >= places.size()) return "end";
  const StatementPlace& where = places[statement];
  return where.label < texts.size() ? texts[where.label] : fmt::format("line {}", where.line);
}

bool Program::releases(std::string_view semaphore) const {
  return std::any_of(statements.begin(), statements.end(), [&](const Statement& statement) {
    const auto* what = std::get_if<SemaphoreStatement>(&statement);
    return what != nullptr && !what->acquire && texts[what->name] == semaphore;
  });
}

std::string name_of_file(std::string_view file) {
  file.remove_prefix(file.find_last_of('/') + 1);  // npos + 1: nothing
  return std::string(file.substr(0, file.find_last_of('.')));
}

}  // namespace cellmirror::program
