// Summaries of cells from anywhere on the network: whatever is read can be written, and is the same then.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "ipc/wire/cell_summary_text.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto read = cellmirror::parse_cell_summary(text);
  if (!read) return 0;
  const std::string written = cellmirror::cell_summary_text(*read);
  if (written.size() > cellmirror::kMostSummaryBytes) std::abort();
  const auto again = cellmirror::parse_cell_summary(written);
  if (!again || again->cell != read->cell || again->robots.size() > read->robots.size()) std::abort();
  return 0;
}
