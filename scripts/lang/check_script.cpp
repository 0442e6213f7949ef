// Checking a text as a whole, before it is executed.
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scripts/lang/reader.hpp"

namespace cellmirror::script {

namespace {

// The directory as it will be behind a ROBACT of the same text.
class FollowedNames final : public NameDirectory {
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

bool may_load(FormId id) { return id == FormId::activate || id == FormId::level_down || id == FormId::exec_script; }

}  // namespace

std::size_t check_script(std::string_view text, std::string_view source, const NameDirectory* names,
                         Diagnostics& diagnostics) {
  CommandReader reader(text, source, TextKind::file);
  reader.set_name_check(NameCheck::ahead);
  std::optional<FollowedNames> followed;
  if (names != nullptr) followed.emplace(*names);
  ParsedCommand command;
  std::size_t count = 0;
  for (;;) {
    const CommandReader::Step step = reader.next(followed ? &*followed : nullptr, command, diagnostics);
    if (step == CommandReader::Step::end) return count;
    ++count;
    if (step != CommandReader::Step::command || !followed) continue;
    if (command.id() == FormId::robact) followed->set_active(command.text(0));
    if (may_load(command.id())) reader.set_name_check(NameCheck::ahead_after_loading);
  }
}

}  // namespace cellmirror::script
