// toml++ with the settings of this folder; compiled once, in toml.cpp. Private to this folder.
#pragma once

#include <stdexcept>

#define TOML_HEADER_ONLY 0
// With exceptions: without them version 3.3 runs on after some errors ("[!") and into its own assertions.
#define TOML_EXCEPTIONS 1
// Text from outside must not be able to end the program, whatever the library has overlooked: caught in parse_toml().
namespace cellmirror {
[[noreturn]] inline void toml_assertion_failed(const char* condition) { throw std::logic_error(condition); }
}  // namespace cellmirror
#define TOML_ASSERT(condition) ((condition) ? static_cast<void>(0) : ::cellmirror::toml_assertion_failed(#condition))
// Limit for nested arrays and inline tables: the parser recurses for each level.
#define TOML_MAX_NESTED_VALUES 32
namespace cellmirror {
inline constexpr int kMostNestedValues = TOML_MAX_NESTED_VALUES;
}  // namespace cellmirror
#define TOML_ENABLE_FORMATTERS 0
#define TOML_ENABLE_WINDOWS_COMPAT 0
#include <toml++/toml.h>
