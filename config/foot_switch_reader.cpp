#include "config/foot_switch_reader.hpp"

#include <fmt/format.h>

#include "config/haptic_reader.hpp"
#include "config/stream_reader.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

constexpr long long kMostBytes = 1'048'576;  // as bin_ela_shm
constexpr double kLongestDebounce = 1.0;

}  // namespace

FootSwitchSettings read_foot_switches(TableReader& top) {
  FootSwitchSettings settings;
  auto table = top.table("foot_switches");
  if (!table) return settings;
  if (const auto key = table->integer("key", 1, 0x7FFF'FFFF)) settings.key = static_cast<std::int32_t>(*key);
  if (const auto bytes = table->integer("bytes", 1, kMostBytes)) settings.bytes = static_cast<std::size_t>(*bytes);
  if (const auto text = table->text("mode")) {
    if (const auto mode = octal(*text)) {
      settings.mode = *mode;
    } else {
      table->error("mode", fmt::format("mode \"{}\" is not a valid mode", printable(*text)),
                   "write e.g. mode = \"0660\"");
    }
  }
  settings.debounce = read_seconds(*table, "debounce_s", kLongestDebounce, true).value_or(settings.debounce);
  settings.online = table->boolean("online").value_or(settings.online);
  if (settings.online && !settings.key && !table->has("key"))
    table->error("online", "online without a key: there is no memory to read", "add a key, or go online by BIN_ELA");
  table->finish();
  return settings;
}

}  // namespace cellmirror
