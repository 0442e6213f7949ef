// Lines of the log about what people and instruments do with the cell: no warnings, and written like these unless only
// errors are.
#pragma once

#include <string_view>

namespace cellmirror {

// As log_text() of the level info otherwise: rate limit by `kind`, observer, journal. Any thread.
void log_notice(std::string_view kind, std::string_view message);

}  // namespace cellmirror
