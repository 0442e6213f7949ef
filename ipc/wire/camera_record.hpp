// Records of online cameras (SENSOR channel, CAM_ONLINE): the commanded direction, for the program that steers the real
// one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "ipc/wire/pose_fields.hpp"
#include "ipc/wire/record.hpp"
#include "ipc/wire/record_fields.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/camera_state.hpp"

namespace cellmirror {

inline constexpr std::uint32_t kCameraTracking = 1;  // it tracks the named frame
inline constexpr std::uint32_t kCameraMirrored = 2;  // its head is mirrored: its posture in the model is the real one's

namespace camera_record_offset {
// From the start of the record.
inline constexpr std::size_t kId = 40;              // char[64]
inline constexpr std::size_t kTracks = 104;         // char[128]
inline constexpr std::size_t kPose = 232;           // pose
inline constexpr std::size_t kMount = 288;          // pose
inline constexpr std::size_t kPan = 344;            // f64
inline constexpr std::size_t kTilt = 352;           // f64
inline constexpr std::size_t kFocalDistance = 360;  // f64
inline constexpr std::size_t kFovy = 368;           // f64
inline constexpr std::size_t kFlags = 376;          // u32
inline constexpr std::size_t kReserved = 380;       // u32, 0
inline constexpr std::size_t kBytes = 384;
}  // namespace camera_record_offset

struct CameraRecord {
  RecordHeader header;
  std::string id;             // name of the camera's workframe
  std::string tracks;         // dotted path of the tracked frame; empty: none
  PoseRecord pose;            // X_WC: commanded pose
  PoseRecord mount;           // X_WM: pose with its pan-tilt head at zero
  double pan = 0;             // rad, about y of the mount
  double tilt = 0;            // rad, then about the new x
  double focal_distance = 0;  // m
  double fovy = 0;            // rad
  bool tracking = false;
  bool mirrored = false;
};

// What a record says of `camera` at the tick of `time`; sequence and wall time stay for the sender to fill in.
[[nodiscard]] CameraRecord camera_record_of(const CameraState& camera, Timestamp time);

// As encode_robot_record: the length that was written; fails where `bytes` is too small (kBytes suffices).
[[nodiscard]] Result<std::size_t> encode_camera_record(const CameraRecord& record, std::span<std::byte> bytes);

// Strict: whatever the encoder would not write is refused. Numbers are passed on as they are, NaN too.
[[nodiscard]] Result<CameraRecord> decode_camera_record(std::span<const std::byte> bytes);

}  // namespace cellmirror
