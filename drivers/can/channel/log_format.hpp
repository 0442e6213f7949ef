// Whether a file is a candump log, by its first lines; what else it is, and what makes a candump log of it. Pure.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "rt_core/base/result.hpp"

namespace cellmirror::can {

inline constexpr std::size_t kLogBeginning = 16'384;  // bytes that are looked at

// `beginning`: at most kLogBeginning bytes of the file; `whole`: it has no more. Passes where a line is candump's, and
// for an empty file. The text of the error has no file name.
[[nodiscard]] Result<void> check_log_beginning(std::string_view beginning, bool whole);
// The same of a file, which has to be readable.
[[nodiscard]] Result<void> check_log(const std::string& file);

}  // namespace cellmirror::can
