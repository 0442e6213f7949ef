// One error for a file with several. Private to this folder.
#pragma once

#include <filesystem>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror {

// "file:1:2: error: ... (and 3 more)", and how all can be seen.
[[nodiscard]] Error first_error(const Diagnostics& diagnostics, const std::filesystem::path& file);

}  // namespace cellmirror
