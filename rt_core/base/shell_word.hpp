// Quotes a text for commands that a message or a file suggests to the user. Pure; allocates, not for the tick.
#pragma once

#include <string>
#include <string_view>

namespace cellmirror {

// One word of a POSIX shell's command line, quoted if necessary.
[[nodiscard]] std::string shell_word(std::string_view text);

}  // namespace cellmirror
