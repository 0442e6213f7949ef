// SCRIPT commands in comments of robot programs, which begin with %: what all languages have in common.
#pragma once

#include <cstdint>
#include <string_view>

#include "rt_core/base/text.hpp"

namespace cellmirror::program {

// The command in trimmed text that a ';' may end; empty where there is none, which is an error of the program.
[[nodiscard]] inline std::string_view script_command(std::string_view text) {
  return text.ends_with(';') ? trimmed(text.substr(0, text.size() - 1)) : text;
}

// Found by a lexer that hands comments over beside its tokens.
struct ScriptComment {
  std::string_view text;  // without the % and the blanks around it
  std::uint32_t line = 1;
  std::uint32_t column = 1;  // in bytes
};

inline constexpr const char* kScriptCommentWithoutCommand = "the comment begins with % but has no SCRIPT command";
inline constexpr const char* kScriptCommentRemedy = "write the command, or delete the %";

}  // namespace cellmirror::program
