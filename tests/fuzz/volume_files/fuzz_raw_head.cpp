// Any bytes as the head of raw data: findings, or files, size and spacing within their limits. No file is opened.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "config/volume/data_files.hpp"
#include "config/volume_file.hpp"
#include "rt_core/base/contract.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  constexpr std::size_t kLargest = 8UL << 10U;
  if (size > kLargest) return 0;
  Diagnostics diagnostics;
  const auto head = parse_raw_volume_head({reinterpret_cast<const char*>(data), size}, "a.toml", diagnostics);
  CELLMIRROR_EXPECTS(head.has_value() == diagnostics.ok());
  if (!head) return 0;
  CELLMIRROR_EXPECTS(!head->files.empty() && head->files.size() <= kMostDataFiles);
  CELLMIRROR_EXPECTS(head->files.size() == 1 || head->files.size() == head->format.size[2]);
  for (const std::uint32_t along : head->format.size) CELLMIRROR_EXPECTS(along >= 2 && along <= kMostVoxelsAlong);
  CELLMIRROR_EXPECTS(check_spacing(head->spacing_m).has_value());
  CELLMIRROR_EXPECTS(std::isfinite(head->slope) && head->slope != 0 && std::isfinite(head->intercept));
  return 0;
}
