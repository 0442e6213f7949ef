// A candump log file: every line is parsed; what was taken is written and read again.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "drivers/can/channel/candump_line.hpp"
#include "drivers/can/channel/log_format.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view text(reinterpret_cast<const char*>(data), size);
  static_cast<void>(
      cellmirror::can::check_log_beginning(text.substr(0, cellmirror::can::kLogBeginning), size % 2 == 0));
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const auto line = cellmirror::can::parse_candump_line(text.substr(0, end));
    if (line) {
      const auto again = cellmirror::can::parse_candump_line(
          cellmirror::can::format_candump_line(line->time_ns, line->interface, line->frame));
      if (!again || again->frame.id != line->frame.id || again->frame.data != line->frame.data) std::abort();
    }
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return 0;
}
