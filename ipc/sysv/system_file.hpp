// Small files of the kernel, as /proc/sys/kernel/msgmax.
#pragma once

#include <cstdint>
#include <filesystem>

namespace cellmirror {

// The number with which the file begins; 0 where it cannot be read or has none.
[[nodiscard]] std::uint64_t number_in(const std::filesystem::path& file);

}  // namespace cellmirror
