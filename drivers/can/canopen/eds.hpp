// EDS and DCF files (CiA 306): the object dictionary of a device, and in it the PDO mapping.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/can/canopen/object_dictionary.hpp"
#include "rt_core/base/diagnostics.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::can {

struct DeviceDescription {
  std::string vendor;
  std::string product;
  // Values: ParameterValue (DCF), else DefaultValue; without both, numbers are 0 and texts empty.
  ObjectDictionary objects;
};

// `node_id` 1..127 takes the place of $NODEID. All errors in one pass; what could be read is returned all the same.
[[nodiscard]] DeviceDescription parse_eds(std::string_view text, const std::string& file, std::uint8_t node_id,
                                          Diagnostics& diagnostics);
// The same from a file; none where it cannot be read (told in `diagnostics`). At most 16 MiB.
[[nodiscard]] std::optional<DeviceDescription> read_eds(const std::string& file, std::uint8_t node_id,
                                                        Diagnostics& diagnostics);

// The TPDOs that exist (valid COB-ID) and hold a valid mapping: objects 0x1800.. and 0x1A00... `node_id` for the
// predefined COB-IDs where the file names none.
[[nodiscard]] std::vector<TpdoConfig> tpdos_of(const ObjectDictionary& objects, std::uint8_t node_id);

}  // namespace cellmirror::can
