#include "drivers/can/channel/log_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "drivers/can/channel/candump_line.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::can {
namespace {

constexpr const char* kLogConvert = "convert it with python-can: 'can_logconvert FILE new.log'";

struct LogMagic {
  std::string_view bytes;
  const char* what;
  const char* remedy;
};
constexpr std::array kMagics = std::to_array<LogMagic>({
    {"\x1F\x8B", "the file is compressed (gzip)", "unpack it with 'gunzip FILE'"},
    {"BZh", "the file is compressed (bzip2)", "unpack it with 'bunzip2 FILE'"},
    {"\xFD"
     "7zXZ",
     "the file is compressed (xz)", "unpack it with 'unxz FILE'"},
    {"\x28\xB5\x2F\xFD", "the file is compressed (zstd)", "unpack it with 'unzstd FILE'"},
    {"PK\x03\x04", "the file is a ZIP archive", "unpack it with 'unzip FILE'"},
    {"LOGG", "the file is a log of Vector's tools (BLF)", kLogConvert},
    {"MDF ", "the file is a measurement (MDF)", kLogConvert},
    {"UnFinMF", "the file is a measurement (MDF)", kLogConvert},
    {"\xD4\xC3\xB2\xA1", "the file is a network capture (pcap)", "record with 'candump -L can0 > new.log'"},
    {"\x0A\x0D\x0D\x0A", "the file is a network capture (pcapng)", "record with 'candump -L can0 > new.log'"},
    {"SQLite format 3", "the file is a database (SQLite)", kLogConvert},
    {"\x89MCAP0", "the file is a recording of cellmirror or ROS (MCAP)",
     "export a candump log from a recording of cellmirror: 'cellmirror recording export FILE --candump new.log'"},
});

bool is_number(std::string_view word) {
  return !word.empty() && std::ranges::all_of(word, [](char c) { return (c >= '0' && c <= '9') || c == '.'; });
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  constexpr std::size_t kEnough = 8;
  while (words.size() < kEnough) {
    const std::size_t begin = line.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos) break;
    line.remove_prefix(begin);
    const std::size_t end = std::min(line.find_first_of(" \t\r"), line.size());
    words.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
  return words;
}

// Returns true for terminal output of candump: "vcan0  123   [8]  11 22", with or without a time stamp before it.
bool is_screen_line(std::span<const std::string_view> words) {
  const std::size_t first = !words.empty() && words[0].starts_with('(') ? 1 : 0;
  if (words.size() < first + 3) return false;
  // The option -x of candump adds the direction, TX or RX, and flags.
  return std::ranges::any_of(words.subspan(first + 2), [](std::string_view word) {
    return word.size() >= 3 && word.front() == '[' && word.back() == ']' && is_number(word.substr(1, word.size() - 2));
  });
}

std::optional<Error> known_format(std::string_view line) {
  const std::vector<std::string_view> words = words_of(line);
  if (words.empty()) return {};
  const std::string first = lower_case(words[0]);
  if (line.starts_with(";$FILEVERSION") || line.starts_with(";##"))
    return Error{"the file is a trace of PEAK's tools (TRC)", kLogConvert};
  const bool asc = (first == "date" && words.size() > 2) || (first == "base" && words.size() > 1) ||
                   (is_number(first) && words.size() > 4 && (words[3] == "Rx" || words[3] == "Tx"));
  if (asc)
    return Error{"the file is a log of Vector's tools (ASC)",
                 "convert it with can-utils: 'asc2log -I FILE -O new.log'"};
  if (line.starts_with("timestamp,") || line.starts_with("Time Stamp,"))
    return Error{"the file is a table (CSV)", kLogConvert};
  if (is_screen_line(words)) {
    return Error{"the file is terminal output of candump, which may lack time stamps",
                 "record with 'candump -L can0 > new.log', or 'candump -l can0'"};
  }
  return {};
}

}  // namespace

Result<void> check_log_beginning(std::string_view beginning, bool whole) {
  for (const LogMagic& magic : kMagics) {
    if (beginning.starts_with(magic.bytes)) return fail(magic.what, magic.remedy);
  }
  std::optional<Error> found;
  std::string reason;
  while (!beginning.empty()) {
    const std::size_t end = beginning.find('\n');
    if (end == std::string_view::npos && !whole) break;  // the line may be incomplete
    const std::string_view line = beginning.substr(0, end);
    beginning.remove_prefix(end == std::string_view::npos ? beginning.size() : end + 1);
    if (trimmed(line).empty()) continue;
    const auto parsed = parse_candump_line(line);
    if (parsed) return {};
    if (reason.empty()) reason = parsed.error();
    if (!found) found = known_format(line);
  }
  if (found) return std::unexpected(*found);
  if (reason.empty()) {
    if (whole) return {};
    reason = "the first line is too long";
  }
  return fail(fmt::format("the file is not a candump log: {}", reason),
              "name a log that 'candump -l' or 'candump -L' has written");
}

}  // namespace cellmirror::can
