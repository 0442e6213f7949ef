// Interface of SCRIPT to voxel volumes (manual 1.2.7). As host.hpp. SI. `volume` names one, as NameKind::volume does;
// empty: all that the cell has, and a cell without any is refused. A done call may have a remark on what has no visible
// effect.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/volume_settings.hpp"

namespace cellmirror {

// The words of VV_CLIP, in the order of its choices. `visible` draws the plane's outline and changes nothing else;
// `off` ends both.
enum class VolumePlaneMode : std::uint8_t { active, reverse, visible, off };

struct VolumePlanePosition {
  double elevation_rad = 0;  // -pi/2 to pi/2
  double azimuth_rad = 0;    // -pi/2 to pi/2
  double distance_m = 0;
};

class VolumeHost {
 public:
  virtual ~VolumeHost() = default;
  // Planes are numbered from 0: CLP1 is 0.
  virtual Result<std::string> set_plane_mode(std::size_t plane, VolumePlaneMode mode, std::string_view volume) = 0;
  virtual Result<std::string> set_plane_position(std::size_t plane, const VolumePlanePosition& position,
                                                 std::string_view volume) = 0;
  virtual Result<std::string> set_table(VolumeTable table, std::string_view volume) = 0;
  virtual Result<std::string> set_medical_table(const MedicalTableParameters& parameters, std::string_view volume) = 0;
  // Of any table but that of medical data.
  virtual Result<std::string> set_table_parameters(VolumeTable table, const VolumeTableParameters& parameters,
                                                   std::string_view volume) = 0;
  // VV_ISO: the surface of a value, in the unit of the volume's values, in place of the table. None: the value stays.
  virtual Result<std::string> set_surface(bool on, std::optional<double> value, std::string_view volume) = 0;
  virtual Result<std::string> reload_tables(std::string_view volume) = 0;
};

}  // namespace cellmirror
