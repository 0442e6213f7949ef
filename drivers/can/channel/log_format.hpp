// Recognizes candump logs by their first lines; names other formats and the command that converts them. Pure.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "rt_core/base/result.hpp"

namespace cellmirror::can {

inline constexpr std::size_t kLogBeginning = 16'384;  // bytes that are examined

// `beginning`: the first bytes of the file, at most kLogBeginning; `whole`: the file has no more. Succeeds if at least
// one line is a frame of a candump log, and for an empty file. The text of the error has no file name.
[[nodiscard]] Result<void> check_log_beginning(std::string_view beginning, bool whole);
// The same for a readable file; the text of the error has the file name.
[[nodiscard]] Result<void> check_log(const std::string& file);

}  // namespace cellmirror::can
