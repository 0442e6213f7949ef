// The data files that the head of a volume names.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/result.hpp"

namespace cellmirror {

inline constexpr std::size_t kMostDataFiles = 4096;  // one a slice

// Names of a pattern with one %d, %3d or %03d, for the numbers from `first` to `last`.
[[nodiscard]] Result<std::vector<std::string>> names_of_pattern(std::string_view pattern, long long first,
                                                                long long last, long long step);

// The file `name` in the folder of `head` or below. Refused: absolute names and names that leave that folder, also
// through links. Whether it can be read is seen when it is.
[[nodiscard]] Result<std::filesystem::path> file_beside(const std::filesystem::path& head, std::string_view name);

}  // namespace cellmirror
