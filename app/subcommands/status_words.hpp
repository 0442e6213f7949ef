// Words and numbers of the status document as its tables for people show them.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

namespace cellmirror::app {

inline std::string text(const nlohmann::json& value) { return value.get<std::string>(); }
inline std::uint64_t count(const nlohmann::json& value) { return value.get<std::uint64_t>(); }

// A number of ms without its unit; "-" where there is none.
inline std::string milliseconds(const nlohmann::json& number, int decimals) {
  return number.is_number() ? fmt::format("{:.{}f}", number.get<double>(), decimals) : std::string("-");
}

}  // namespace cellmirror::app
