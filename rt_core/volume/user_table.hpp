// The text of a user's look-up table: rows `value red green blue opacity`, colours and opacity 0 to 1, values strictly
// rising; `#` starts a comment. Between rows everything is interpolated, beyond them that of the first or last row
// holds.
#pragma once

#include <optional>
#include <string_view>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/ports/volume_user_table.hpp"

namespace cellmirror::volume {

inline constexpr std::size_t kMostUserRows = 4096;
inline constexpr std::size_t kLongestUserTable = 1U << 20U;  // bytes

// None where the text has an error; all errors are in `diagnostics`, with file and line. Not real time.
[[nodiscard]] std::optional<VolumeUserTable> parse_user_table(std::string_view text, std::string_view file,
                                                              Diagnostics& diagnostics);

}  // namespace cellmirror::volume
