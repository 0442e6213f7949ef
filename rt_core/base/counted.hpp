// Numbers of things, as sentences have them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace cellmirror {

// "1 file", "2 files", "0 files". `many`: where it is not `one` with an s.
[[nodiscard]] std::string number_of(std::uint64_t count, std::string_view one, std::string_view many = {});

}  // namespace cellmirror
