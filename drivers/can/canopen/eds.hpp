// EDS and DCF files (CiA 306): the object dictionary of a device, and in it the PDO mapping.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
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
  // Faulty objects: their value is 0, or they are left out. A fault is an error if the object is used.
  std::map<ObjectAddress, Diagnostic> faults;
  std::optional<std::uint8_t> commissioned_node;  // NodeID of a DCF
  Place commissioned_place;
};

// `node_id` 1..127 replaces $NODEID. Reports all findings in one pass; returns the objects that could be read.
// An unreadable line or object is a warning, since a cell uses few objects of a file; a file without objects is an
// error.
[[nodiscard]] DeviceDescription parse_eds(std::string_view text, const std::string& file, std::uint8_t node_id,
                                          Diagnostics& diagnostics);
// The same from a file; none where it cannot be read (told in `diagnostics`). At most 16 MiB.
[[nodiscard]] std::optional<DeviceDescription> read_eds(const std::string& file, std::uint8_t node_id,
                                                        Diagnostics& diagnostics);

// The TPDOs that exist (valid COB-ID) and hold a valid mapping: objects 0x1800.. and 0x1A00... `node_id` for the
// predefined COB-IDs where the file names none. Faults of objects that a stream needs are errors in `file`.
[[nodiscard]] std::vector<TpdoConfig> tpdos_of(const DeviceDescription& device, std::uint8_t node_id,
                                               const std::string& file, Diagnostics& diagnostics);
// Warns if the DCF was written for another node, and if a TPDO has the COB-ID of another node.
void warn_of_foreign_node(const DeviceDescription& device, std::span<const TpdoConfig> tpdos, std::uint8_t node_id,
                          const std::string& file, Diagnostics& diagnostics);

// Returns true if the device has a position actual value (0x6064) or its device type (0x1000) is a drive (CiA 402).
[[nodiscard]] bool is_drive(const DeviceDescription& device);

}  // namespace cellmirror::can
