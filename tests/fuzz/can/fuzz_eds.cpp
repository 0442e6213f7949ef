// An EDS or DCF file, and the TPDOs in it.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "drivers/can/canopen/eds.hpp"
#include "drivers/can/canopen/pdo.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  Diagnostics diagnostics;
  const auto device = can::parse_eds({reinterpret_cast<const char*>(data), size}, "fuzz.eds", 3, diagnostics);
  for (const TpdoConfig& tpdo : can::tpdos_of(device.objects, 3)) {
    if (!can::is_valid_mapping(tpdo.entries)) std::abort();
  }
  return 0;
}
