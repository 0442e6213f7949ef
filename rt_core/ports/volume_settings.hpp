// What SCRIPT asks for of voxel volumes (manual 1.2.7): clipping planes, look-up tables. Shared by commands, cell
// files, reports, the page and the ray caster. SI and radians; SCRIPT has mm and degrees.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string_view>

namespace cellmirror {

// VV_CLIP.
enum class VolumePlaneSide : std::uint8_t {
  none,    // clips nothing
  beyond,  // `active`: what is farther along the normal than the distance is not drawn
  before,  // `reverse`: what is not as far is not drawn
};

inline constexpr std::size_t kVolumePlanes = 6;
inline constexpr std::array<std::string_view, kVolumePlanes> kVolumePlaneWords = {"CLP1", "CLP2", "CLP3",
                                                                                  "CLP4", "CLP5", "CLP6"};

// The plane n . p = distance in the volume's frame V, whose origin is the middle of the volume;
// n = (cos e cos a, cos e sin a, sin e).
struct VolumePlane {
  VolumePlaneSide side = VolumePlaneSide::none;
  bool framed = false;       // `visible`: its outline within the volume is drawn; `off` ends it
  double elevation_rad = 0;  // e: -pi/2 to pi/2
  double azimuth_rad = 0;    // a: -pi/2 to pi/2
  double distance_m = 0;
  bool operator==(const VolumePlane&) const = default;
};

// VV_SET_LUT.
enum class VolumeTable : std::uint8_t { medical, linear, exponential, rainbow, user1, user2 };
inline constexpr std::size_t kVolumeTables = 6;
inline constexpr std::array<std::string_view, kVolumeTables> kVolumeTableWords = {
    "MEDICAL_LUT", "LIN_LUT", "EXP_LUT", "RAINBOW_LUT", "USER1_LUT", "USER2_LUT"};

// VV_SET_LUT_PAR MEDICAL_LUT: how much of each kind of material is seen, 0 to 1.
struct MedicalTableParameters {
  double air = 0;
  double fat = 0.1;
  double tissue = 0.3;
  double bone = 1;
  bool operator==(const MedicalTableParameters&) const = default;
};

// VV_SET_LUT_PAR of the other tables. Ranges: manual 1.2.7.
struct VolumeTableParameters {
  double opacity = 1;                    // 0 to 3
  double gain = 1;                       // 0 to 20
  double level = 2;                      // 1 to 3
  double window = std::numbers::pi / 4;  // 0 to 1.57
  bool operator==(const VolumeTableParameters&) const = default;
};
inline constexpr double kMostVolumeOpacity = 3;
inline constexpr double kMostVolumeGain = 20;
inline constexpr double kLeastVolumeLevel = 1;
inline constexpr double kMostVolumeLevel = 3;
inline constexpr double kMostVolumeWindow = 1.57;

// Of one volume.
struct VolumeSettings {
  std::array<VolumePlane, kVolumePlanes> planes{};
  VolumeTable table = VolumeTable::medical;
  MedicalTableParameters medical;
  std::array<VolumeTableParameters, kVolumeTables> parameters{};  // by VolumeTable; that of `medical` is unused
  bool isosurface = false;  // only the surface of `iso_value` is drawn, lit and opaque
  double iso_value = 300;   // in the unit of VoxelGrid::value()
  bool operator==(const VolumeSettings&) const = default;
};

}  // namespace cellmirror
