#include "config/volume/data_files.hpp"

#include <fmt/format.h>

#include <system_error>

#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace fs = std::filesystem;

Result<std::vector<std::string>> names_of_pattern(std::string_view pattern, long long first, long long last,
                                                  long long step) {
  const auto refuse = [&] {
    return fail(fmt::format("\"{}\" is no pattern of file names", printable(pattern)),
                "write one %d, %3d or %03d for the number");
  };
  const std::size_t at = pattern.find('%');
  if (at == std::string_view::npos) return refuse();
  std::size_t end = at + 1;
  const bool zeros = end < pattern.size() && pattern[end] == '0';
  if (zeros) ++end;
  std::size_t width = 0;
  if (end < pattern.size() && pattern[end] >= '1' && pattern[end] <= '9')
    width = static_cast<std::size_t>(pattern[end++] - '0');
  if (end >= pattern.size() || pattern[end] != 'd' || pattern.find('%', end) != std::string_view::npos) return refuse();
  constexpr long long kMostNumber = 1'000'000'000;
  if (step == 0 || std::abs(first) > kMostNumber || std::abs(last) > kMostNumber || std::abs(step) > kMostNumber ||
      (last - first) / step < 0)
    return fail(fmt::format("the numbers {} to {} by {} are no sequence", first, last, step));
  const auto count = static_cast<std::size_t>((last - first) / step) + 1;
  if (count > kMostDataFiles)
    return fail(fmt::format("{} data files are more than {}", count, kMostDataFiles), "put the slices into one file");
  std::vector<std::string> out;
  for (std::size_t i = 0; i < count; ++i) {
    const long long number = first + static_cast<long long>(i) * step;
    const std::string text = zeros ? fmt::format("{:0{}d}", number, width) : fmt::format("{:{}d}", number, width);
    out.push_back(fmt::format("{}{}{}", pattern.substr(0, at), text, pattern.substr(end + 1)));
  }
  return out;
}

Result<fs::path> file_beside(const fs::path& head, std::string_view name) {
  constexpr std::size_t kLongestName = 1024;
  if (name.empty() || name.size() > kLongestName || name.find('\0') != std::string_view::npos)
    return fail("the name of a data file is empty or too long");
  const std::string remedy = "put the data beside the head, and name them relative to it";
  if (fs::path(name).is_absolute()) return fail(fmt::format("the path {} is absolute", printable(name)), remedy);
  std::error_code error;
  const fs::path folder = fs::weakly_canonical(head, error).parent_path();
  if (error) return fail(fmt::format("{} cannot be opened: {}", printable(head.string()), error.message()));
  const fs::path found = fs::weakly_canonical(folder / name, error);
  if (error) return fail(fmt::format("{} cannot be opened: {}", printable(name), error.message()));
  const fs::path relative = found.lexically_relative(folder);
  if (relative.empty() || *relative.begin() == "..")
    return fail(fmt::format("the path {} leaves {}", printable(name), folder.string()), remedy);
  return found;
}

}  // namespace cellmirror
