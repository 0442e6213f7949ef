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
  // Objects that the file describes wrongly, whose value is 0 or that are left out: errors for who uses them.
  std::map<ObjectAddress, Diagnostic> faults;
  std::optional<std::uint8_t> commissioned_node;  // of a DCF
  Place commissioned_place;
};

// `node_id` 1..127 takes the place of $NODEID. All findings in one pass; what could be read is returned all the same.
// A line or object that cannot be read is a warning, since few objects of a file are used; a file without objects is an
// error.
[[nodiscard]] DeviceDescription parse_eds(std::string_view text, const std::string& file, std::uint8_t node_id,
                                          Diagnostics& diagnostics);
// The same from a file; none where it cannot be read (told in `diagnostics`). At most 16 MiB.
[[nodiscard]] std::optional<DeviceDescription> read_eds(const std::string& file, std::uint8_t node_id,
                                                        Diagnostics& diagnostics);

// The TPDOs that exist (valid COB-ID) and hold a valid mapping: objects 0x1800.. and 0x1A00... `node_id` for the
// predefined COB-IDs where the file names none. Faults of objects that a stream needs are errors; `file` is their
// place.
[[nodiscard]] std::vector<TpdoConfig> tpdos_of(const DeviceDescription& device, std::uint8_t node_id,
                                               const std::string& file, Diagnostics& diagnostics);
// Warns of a DCF of another node, and of TPDOs with the COB-ID of another node.
void warn_of_foreign_node(const DeviceDescription& device, std::span<const TpdoConfig> tpdos, std::uint8_t node_id,
                          const std::string& file, Diagnostics& diagnostics);

// Whether the device has a position actual value, or calls itself a drive (CiA 402) in its device type.
[[nodiscard]] bool is_drive(const DeviceDescription& device);

}  // namespace cellmirror::can
