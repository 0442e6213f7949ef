// Motion files: whatever stands in them, the reader ends, and what it calls usable is usable.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "sim_devices/motion/motion_table.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  Diagnostics diagnostics;
  const sim::MotionTable table =
      sim::read_motion_table({reinterpret_cast<const char*>(data), size}, "fuzz.csv", diagnostics);
  if (table.position.size() != table.rows() * table.joints) std::abort();
  if (diagnostics.ok() && table.rows() == 0) std::abort();
  for (std::size_t i = 0; i < table.rows(); ++i) {
    if (i > 0 && !(table.time_s[i] > table.time_s[i - 1])) std::abort();
    for (std::size_t j = 0; j < table.joints; ++j) {
      if (!std::isfinite(table.row(i)[j])) std::abort();
    }
  }
  return 0;
}
