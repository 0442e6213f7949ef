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
  for (const TpdoConfig& tpdo : can::tpdos_of(device, 3, "fuzz.eds", diagnostics)) {
    if (!can::is_valid_mapping(tpdo.entries)) std::abort();
  }
  static_cast<void>(can::is_drive(device));
  can::warn_of_foreign_node(device, can::tpdos_of(device, 5, "fuzz.eds", diagnostics), 5, "fuzz.eds", diagnostics);
  return 0;
}
