#include "rt_core/base/utc_text.hpp"

#include <fmt/format.h>

#include <ctime>

namespace cellmirror {

namespace {

// Without the Z.
std::string seconds_text(std::time_t seconds) {
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}", utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday,
                     utc.tm_hour, utc.tm_min, utc.tm_sec);
}

}  // namespace

std::string utc_text(std::int64_t wall_ns) { return seconds_text(wall_ns / 1'000'000'000) + "Z"; }

std::string utc_text_ms(std::int64_t wall_ns) {
  return fmt::format("{}.{:03}Z", seconds_text(wall_ns / 1'000'000'000), wall_ns / 1'000'000 % 1000);
}

}  // namespace cellmirror
