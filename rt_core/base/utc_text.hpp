// Times of the wall clock for logs and records.
#pragma once

#include <cstdint>
#include <string>

namespace cellmirror {

// ISO 8601 in UTC, cut and not rounded: "2026-11-21T10:00:00Z". `wall_ns`: ns since 1970.
[[nodiscard]] std::string utc_text(std::int64_t wall_ns);
// The same with milliseconds: "2026-11-21T10:00:00.123Z".
[[nodiscard]] std::string utc_text_ms(std::int64_t wall_ns);

}  // namespace cellmirror
