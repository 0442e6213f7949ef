// Checking a text as a whole, before it is executed.
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scripts/lang/reader.hpp"

namespace cellmirror::script {

// The directory as it will be behind a ROBACT of the same text.
class ScriptChecker::FollowedNames final : public NameDirectory {
 public:
  explicit FollowedNames(const NameDirectory& names) : names_(names), active_(names.active_robot()) {}

  void set_active(std::string_view robot) { active_ = robot; }

  [[nodiscard]] bool knows(NameKind kind, std::string_view name) const override { return names_.knows(kind, name); }
  [[nodiscard]] Error explain(NameKind kind, std::string_view name) const override {
    return names_.explain(kind, name);
  }
  [[nodiscard]] std::span<const JointKind> joints(std::string_view robot) const override {
    return names_.joints(robot);
  }
  [[nodiscard]] std::vector<std::string> joint_names(std::string_view robot) const override {
    return names_.joint_names(robot);
  }
  [[nodiscard]] std::string_view active_robot() const override { return active_; }
  [[nodiscard]] std::vector<std::string> all(NameKind kind) const override { return names_.all(kind); }

 private:
  const NameDirectory& names_;
  std::string active_;
};

namespace {

bool may_load(FormId id) { return id == FormId::activate || id == FormId::level_down || id == FormId::exec_script; }

}  // namespace

ScriptChecker::ScriptChecker(const NameDirectory* names, CommandVisitor visit)
    : names_(names == nullptr ? nullptr : std::make_unique<FollowedNames>(*names)), visit_(std::move(visit)) {}

ScriptChecker::~ScriptChecker() = default;

std::size_t ScriptChecker::check(std::string_view text, std::string_view source, TextKind kind,
                                 Diagnostics& diagnostics) {
  CommandReader reader(text, source, kind);
  reader.set_name_check(name_check_);
  ParsedCommand command;
  std::size_t count = 0;
  for (;;) {
    const CommandReader::Step step = reader.next(names_.get(), command, diagnostics);
    if (step == CommandReader::Step::end) return count;
    ++count;
    if (step != CommandReader::Step::command) continue;
    if (visit_) visit(command, text, source);
    if (!names_) continue;
    if (command.id() == FormId::robact) names_->set_active(command.text(0));
    if (may_load(command.id())) name_check_ = NameCheck::ahead_after_loading;
    reader.set_name_check(name_check_);
  }
}

void ScriptChecker::visit(const ParsedCommand& command, std::string_view text, std::string_view source) const {
  const auto place_of = [&](std::string_view word) {
    Place place{std::string(source), command.begin().line, command.begin().column};
    const auto end = static_cast<std::size_t>(word.data() - text.data());
    for (std::size_t i = command.begin().offset; i < end; ++i) {
      ++place.column;
      if (text[i] != '\n') continue;
      ++place.line;
      place.column = 1;
    }
    return place;
  };
  visit_(command, place_of);
}

std::size_t check_script(std::string_view text, std::string_view source, const NameDirectory* names,
                         Diagnostics& diagnostics) {
  return ScriptChecker(names).check(text, source, TextKind::file, diagnostics);
}

}  // namespace cellmirror::script
