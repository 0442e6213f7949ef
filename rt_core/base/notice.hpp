// Log lines about the actions of people and instruments. They are not warnings, but are written wherever warnings are
// written.
#pragma once

#include <string_view>

namespace cellmirror {

// Writes at level info; rate limit by `kind`, observer and journal are those of log_text(). Any thread.
void log_notice(std::string_view kind, std::string_view message);

}  // namespace cellmirror
