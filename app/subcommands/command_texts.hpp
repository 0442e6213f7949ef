// The commands of a SCRIPT text, one after the other, as they are sent as messages.
#pragma once

#include <cstddef>
#include <istream>
#include <string>

#include "rt_core/base/result.hpp"

namespace cellmirror::app {

// A command ends with ';' and may run over several lines; `#` in column 1 makes a comment line; the last command may
// lack its ';'; a first line `RBv01r01` and a byte order mark are passed over (docs/script.md). What is wrong with a
// command is reported by its executor.
class CommandTexts {
 public:
  // `text` outlives it. It is read no further than to the end of a command, so that what comes through a pipe is sent
  // at once.
  explicit CommandTexts(std::istream& text) : in_(text) {}

  // The next command, without its ';' and the blanks at both ends. Empty: there is none. Refused: one longer than
  // SCRIPT takes, or the text cannot be read.
  [[nodiscard]] Result<std::string> next();
  // Of the command that next() gave: where it begins.
  [[nodiscard]] std::size_t line() const { return begin_line_; }

 private:
  void skip_mark();
  void skip_line();

  std::istream& in_;
  bool started_ = false;
  bool at_line_start_ = true;
  std::size_t line_ = 1;
  std::size_t begin_line_ = 1;
};

}  // namespace cellmirror::app
