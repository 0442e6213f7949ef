// Matches the words of a command with the parameters of its form, checks them and fills the command. Private to the
// folder.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "rt_core/base/diagnostics.hpp"
#include "scripts/lang/lexer.hpp"
#include "scripts/lang/names.hpp"
#include "scripts/lang/parsed_command.hpp"
#include "scripts/lang/reader.hpp"

namespace cellmirror::script {

// Destination of diagnostics, and their command.
class Findings {
 public:
  Findings(Diagnostics& diagnostics, const std::string& source, std::string_view command)
      : diagnostics_(diagnostics), source_(source), command_(command) {}

  // "command: message", at the place.
  void error(const Position& at, std::string_view message, std::string remedy = {});
  void warning(const Position& at, std::string_view message, std::string remedy = {});
  [[nodiscard]] bool ok() const { return ok_; }

 private:
  Diagnostics& diagnostics_;
  const std::string& source_;
  std::string_view command_;
  bool ok_ = true;
};

class Matcher {
 public:
  // `words`: without the command's own name. `end`: where the command ends.
  Matcher(const Form& form, std::span<const Token> words, Position end, const NameDirectory* names, NameCheck check,
          ParsedCommand& out, Findings& findings)
      : form_(form), words_(words), end_(end), names_(names), check_(check), out_(out), findings_(findings) {}

  // Fills the command; false where something was found.
  bool match();

 private:
  static constexpr std::size_t kMaxParameters = 16;

  bool match_parameter(std::size_t index);
  bool match_word(const Parameter& parameter);
  void match_single(const Parameter& parameter, const Token& word);
  // The groups from this parameter on; returns the parameter behind them.
  std::size_t match_labelled(std::size_t first);
  void match_group(std::size_t index, const Token& label, std::size_t slot);
  void match_joint_list(const Parameter& parameter);
  void match_number_list(const Parameter& parameter);
  void match_slaves();
  bool match_slave(std::size_t number, std::string_view master);
  void match_joint_pair(std::string_view master, std::string_view slave);

  void check_commas();
  void check_active_robot();
  void require_active_robot();
  void check_dependencies();
  void check_name(const Parameter& parameter, const Token& word);
  bool check_text(const Token& word, std::string_view meaning, std::size_t longest);
  void check_joint_name(std::string_view robot, const Token& word);
  bool check_joint_count(const Parameter& parameter, std::size_t given, std::size_t joints, std::string_view robot);
  [[nodiscard]] double value_of(const Parameter& parameter, const Token& word, JointKind kind);

  [[nodiscard]] Unit unit_of(const Parameter& parameter) const;
  [[nodiscard]] Range range_of(const Parameter& parameter) const;
  [[nodiscard]] JointKind effector_joint_kind();
  [[nodiscard]] std::string_view robot_concerned() const;
  [[nodiscard]] std::span<const JointKind> joint_kinds() const;
  void missing(const Parameter& parameter);
  void surplus(const Token& word);
  void no_choice(std::string_view meaning, const Token& word, std::span<const std::string> accepted);
  [[nodiscard]] std::string expected() const { return "expected: " + std::string(form_.syntax); }

  const Form& form_;
  std::span<const Token> words_;
  Position end_;
  const NameDirectory* names_;
  NameCheck check_;
  ParsedCommand& out_;
  Findings& findings_;
  std::size_t next_ = 0;  // the word to be matched next
};

}  // namespace cellmirror::script
