// Reads SCRIPT text command by command: lexing, parsing, checking. Never throws, allocates nothing unless it finds an
// error, and continues after an error with the next command, so that one pass reports all.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "rt_core/base/diagnostics.hpp"
#include "scripts/lang/lexer.hpp"
#include "scripts/lang/names.hpp"
#include "scripts/lang/parsed_command.hpp"

namespace cellmirror::script {

enum class TextKind : std::uint8_t {
  file,     // commands end with ';'; the last one may lack it
  message,  // one command; a ';' behind it is tolerated
};

enum class NameCheck : std::uint8_t {
  for_execution,        // names must exist now
  ahead,                // before execution: without an active robot only a warning, since a caller may set one
  ahead_after_loading,  // besides, unknown frames only a warning, since an earlier command may have loaded them
};

inline constexpr std::size_t kMaxWords = kMaxValues + 8;  // of one command

class CommandReader {
 public:
  enum class Step : std::uint8_t {
    command,  // `out` holds a command
    comment,  // a message that holds a comment only
    error,    // a command was skipped; the reasons were added to the diagnostics
    end,
  };

  // `text` must stay where it is while the reader and the commands it filled are used. `source` names it in
  // diagnostics. Text beyond kMaxScriptBytes is refused as a whole.
  CommandReader(std::string_view text, std::string_view source, TextKind kind);

  // The next command. Without `names` only syntax, counts, types, units and ranges are checked.
  Step next(const NameDirectory* names, ParsedCommand& out, Diagnostics& diagnostics);

  void set_name_check(NameCheck check) { name_check_ = check; }
  // Position of the reader.
  [[nodiscard]] Position position() const { return lexer_.position(); }

 private:
  bool start(Diagnostics& diagnostics);
  Step read_command(const Token& head, const NameDirectory* names, ParsedCommand& out, Diagnostics& diagnostics);
  Step finish_message(Step step, Diagnostics& diagnostics);

  std::string source_;
  TextKind kind_;
  NameCheck name_check_ = NameCheck::for_execution;
  bool started_ = false;
  bool finished_ = false;
  int text_end_line_ = 0;  // of the last text of hot_message; 0: none
  Lexer lexer_;
  std::array<Token, kMaxWords> words_;  // of the command that is being read; kept to spare their initialisation
};

// Called for each command read without an error. `place_of`: place of a word of the command.
using CommandVisitor =
    std::function<void(const ParsedCommand& command, const std::function<Place(std::string_view word)>& place_of)>;

// Checks whole texts before they are executed, one behind the other as they will be: what a text does to names (ROBACT,
// commands that load) holds for those behind it. One thread.
class ScriptChecker {
 public:
  // `names` may be null; it outlives the checker.
  explicit ScriptChecker(const NameDirectory* names, CommandVisitor visit = {});
  ~ScriptChecker();
  ScriptChecker(const ScriptChecker&) = delete;
  ScriptChecker& operator=(const ScriptChecker&) = delete;

  // Adds every finding. Returns the number of commands read, correct or not.
  std::size_t check(std::string_view text, std::string_view source, TextKind kind, Diagnostics& diagnostics);

 private:
  class FollowedNames;
  void visit(const ParsedCommand& command, std::string_view text, std::string_view source) const;

  std::unique_ptr<FollowedNames> names_;  // null: none
  CommandVisitor visit_;
  NameCheck name_check_ = NameCheck::ahead;
};

// Checks a whole text; adds every finding. With `names` ROBACT is followed, so that joint lists are checked against the
// robot that will be active. Returns the number of commands read, correct or not.
std::size_t check_script(std::string_view text, std::string_view source, const NameDirectory* names,
                         Diagnostics& diagnostics);

// Limits on input.
inline constexpr std::size_t kMaxScriptBytes = 32UL * 1024 * 1024;  // of one file
inline constexpr std::size_t kMaxCommandBytes = 16UL * 1024;        // of one command
inline constexpr std::size_t kMaxFramePath = 512;                   // of a dotted path

}  // namespace cellmirror::script
