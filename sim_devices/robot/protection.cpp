#include "sim_devices/robot/protection.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <utility>

#include "rt_core/base/text.hpp"
#include "sim_devices/base/text_items.hpp"

namespace cellmirror::sim {
namespace {

constexpr std::size_t kMostKeys = 16;
constexpr std::size_t kMostIdNumbers = 16;

template <class Value, std::size_t n>
std::optional<Value> choose(std::string_view word, const std::array<std::pair<std::string_view, Value>, n>& words) {
  for (const auto& [name, value] : words) {
    if (name == word) return value;
  }
  return std::nullopt;
}

template <class Number>
bool take_number(std::string_view text, long long most, Number& out) {
  const auto number = parse_integer(text);
  if (!number || *number < 0 || *number > most) return false;
  out = static_cast<Number>(*number);
  return true;
}

bool take_data_id(std::string_view text, E2eConfig& config) {
  for (const std::string_view item : split(text, '+', kMostIdNumbers + 1)) {
    std::uint16_t number = 0;
    if (config.data_id.size() == kMostIdNumbers || !take_number(item, 0xFFFF, number)) return false;
    config.data_id.push_back(number);
  }
  return true;
}

bool take(const KeyValue& item, E2eConfig& config) {
  constexpr std::array<std::pair<std::string_view, E2eProfile>, 4> kProfiles = {{{"p01", E2eProfile::p01},
                                                                                 {"p02", E2eProfile::p02},
                                                                                 {"p05", E2eProfile::p05},
                                                                                 {"described", E2eProfile::described}}};
  constexpr std::array<std::pair<std::string_view, E2eDataIdMode>, 4> kModes = {
      {{"both", E2eDataIdMode::both},
       {"alternating", E2eDataIdMode::alternating},
       {"low", E2eDataIdMode::low},
       {"nibble", E2eDataIdMode::nibble}}};
  if (item.key == "profile") {
    const auto profile = choose(item.value, kProfiles);
    config.profile = profile.value_or(E2eProfile::p01);
    return profile.has_value();
  }
  if (item.key == "data_id_mode") {
    const auto mode = choose(item.value, kModes);
    config.data_id_mode = mode.value_or(E2eDataIdMode::both);
    return mode.has_value();
  }
  if (item.key == "data_id" || item.key == "data_ids") return take_data_id(item.value, config);
  if (item.key == "counter") config.counter_signal = item.value;
  if (item.key == "crc") config.crc_signal = item.value;
  if (item.key == "counter" || item.key == "crc") return !item.value.empty();
  if (item.key == "crc_bits") return take_number(item.value, 16, config.crc.width);
  if (item.key == "crc_polynomial") return take_number(item.value, 0xFFFF, config.crc.polynomial);
  if (item.key == "crc_initial") return take_number(item.value, 0xFFFF, config.crc.initial);
  if (item.key == "crc_xor") return take_number(item.value, 0xFFFF, config.crc.final_xor);
  if (item.key == "last_counter") return take_number(item.value, 0xFFFF, config.last_counter);
  if (item.key == "data_id_first") return take_number(item.value, 1, config.data_id_first);
  return false;
}

}  // namespace

Result<E2eConfig> parse_protection(std::string_view text) {
  E2eConfig config;
  const std::size_t colon = text.find(':');
  config.message = std::string(text.substr(0, colon));
  if (colon == std::string_view::npos || config.message.empty())
    return fail(fmt::format("--e2e '{}' is not MESSAGE:key=value,...", printable(text)),
                "e.g. --e2e Axis1:profile=p01,data_id=0x123");
  for (const std::string_view word : split(text.substr(colon + 1), ',', kMostKeys)) {
    const auto item = parse_key_value(word);
    if (!item || !take(*item, config))
      return fail(fmt::format("--e2e {}: '{}'", printable(config.message), printable(word)),
                  "the keys and values are those of [[stream.e2e]] (docs/plausibility.md)");
  }
  return config;
}

}  // namespace cellmirror::sim
