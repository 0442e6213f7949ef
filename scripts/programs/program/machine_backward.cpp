// Reversible programs run backward: from check point to check point. Such a program has no jumps, so the check points
// before position_ are those that have been given.
#include <algorithm>
#include <iterator>

#include "scripts/programs/program/machine.hpp"
#include "scripts/programs/program/program_check.hpp"

namespace cellmirror::program {

// With the settings that are in force on the way to each.
void Machine::find_check_points() {
  check_points_.clear();
  const MotionSettings now = settings_;
  settings_ = {};
  for (StatementId id = 0; id < program_->statements.size(); ++id) {
    const Statement& statement = program_->statements[id];
    if (const auto* set = std::get_if<SetStatement>(&statement)) {
      // Checked by check_program(), since the value is constant.
      [[maybe_unused]] const auto done = apply_setting(set->setting, constant_number(*program_, set->value));
    }
    if (std::holds_alternative<MoveStatement>(statement)) check_points_.push_back({id, settings_});
  }
  settings_ = now;
}

// Those in force before the statement at position_.
void Machine::find_settings() {
  settings_ = {};
  for (StatementId id = 0; id < position_ && id < program_->statements.size(); ++id) {
    const auto* set = std::get_if<SetStatement>(&program_->statements[id]);
    if (set == nullptr) continue;
    [[maybe_unused]] const auto done = apply_setting(set->setting, constant_number(*program_, set->value));
  }
}

Result<void> Machine::set_direction(Direction direction) {
  if (!program_->reversible) {
    if (direction == Direction::forward) return {};
    return fail("the program '" + program_->name + "' cannot be run backward",
                "only lists of check points can: jet_boom, jet_tarm");
  }
  if (failed_) return fail("the program '" + program_->name + "' has failed", "run it again");
  if (direction == direction_) return {};
  direction_ = direction;
  if (direction == Direction::forward) {
    behind_end_ = false;
    find_settings();
    return {};
  }
  find_check_points();
  if (executed_ == 0 && position_ == 0) {
    behind_end_ = true;
    position_ = static_cast<StatementId>(program_->statements.size());
  }
  return {};
}

Result<void> Machine::stand_at(StatementId check_point) {
  const bool there = program_->reversible && check_point < program_->statements.size() &&
                     std::holds_alternative<MoveStatement>(program_->statements[check_point]);
  if (!there) return fail("the program '" + program_->name + "' has no such check point");
  position_ = check_point + 1;
  behind_end_ = false;
  find_settings();
  return {};
}

Result<void> Machine::go_on_with(StatementId statement) {
  if (!program_->reversible) return fail("the program '" + program_->name + "' has only one direction");
  behind_end_ = false;
  if (direction_ == Direction::forward) {
    position_ = std::min(statement, static_cast<StatementId>(program_->statements.size()));
    find_settings();
    return {};
  }
  const auto to = std::ranges::find(check_points_, statement, &CheckPoint::statement);
  if (to == check_points_.end()) return fail("the program '" + program_->name + "' has no such check point");
  const auto from = std::next(to);
  behind_end_ = from == check_points_.end();
  position_ = behind_end_ ? static_cast<StatementId>(program_->statements.size()) : from->statement + 1;
  return {};
}

Machine::Step Machine::next_backward(const ProgramWorld& world) {
  const auto behind = std::partition_point(check_points_.begin(), check_points_.end(),
                                           [&](const CheckPoint& point) { return point.statement < position_; });
  auto given = static_cast<std::size_t>(behind - check_points_.begin());
  if (behind_end_) ++given;  // as if there were one behind the last
  if (given < 2) return Step::ended;
  const CheckPoint& to = check_points_[given - 2];
  const CheckPoint& way = behind_end_ ? to : check_points_[given - 1];
  const auto& to_move = std::get<MoveStatement>(program_->statements[to.statement]);
  const auto& way_move = std::get<MoveStatement>(program_->statements[way.statement]);
  MoveCommand move;
  move.path = way_move.path;
  move.fly = to_move.fly;
  move.settings = way.settings;
  move.settings.fly_type = to.settings.fly_type;
  move.settings.fly_parameter = to.settings.fly_parameter;
  auto target = evaluate_target(world, to_move.kind, to_move.target);
  if (!target) return failed(to.statement, target.error());
  move.target = *target;
  if (way_move.path == PathKind::circular) {
    auto via = evaluate_target(world, way_move.kind, way_move.via);
    if (!via) return failed(way.statement, via.error());
    move.via = *via;
  }
  behind_end_ = false;
  rested_ = false;
  ++executed_;
  position_ = to.statement + 1;
  command_ = {.statement = to.statement, .what = std::move(move)};
  return Step::command;
}

}  // namespace cellmirror::program
