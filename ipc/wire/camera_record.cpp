#include "ipc/wire/camera_record.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ipc/wire/little_endian.hpp"

namespace cellmirror {
namespace {

using namespace little_endian;
using namespace camera_record_offset;

constexpr std::uint32_t kAllFlags = kCameraTracking | kCameraMirrored;

std::uint32_t flags_of(const CameraRecord& record) {
  return (record.tracking ? kCameraTracking : 0U) | (record.mirrored ? kCameraMirrored : 0U);
}

Result<void> get_flags(std::span<const std::byte> bytes, CameraRecord& record) {
  const auto flags = get<std::uint32_t>(bytes, kFlags);
  if ((flags & ~kAllFlags) != 0) return fail(fmt::format("flags {:#x} of a camera are unknown", flags));
  record.tracking = (flags & kCameraTracking) != 0;
  record.mirrored = (flags & kCameraMirrored) != 0;
  if (record.tracking == record.tracks.empty()) return fail("a camera with contradictory flags and target");
  if (get<std::uint32_t>(bytes, kReserved) != 0) return fail("reserved bytes of a camera are not 0");
  return {};
}

}  // namespace

CameraRecord camera_record_of(const CameraState& camera, Timestamp time) {
  CameraRecord record;
  record.header.time_ns = time.ns;
  record.id = camera.name;
  record.tracks = camera.tracking ? camera.tracks : std::string{};
  record.pose = pose_record_of(camera.X_WC);
  record.mount = pose_record_of(camera.X_WM);
  record.pan = camera.pan_rad;
  record.tilt = camera.tilt_rad;
  record.focal_distance = camera.focal_distance_m;
  record.fovy = camera.fovy_rad;
  record.tracking = camera.tracking;
  record.mirrored = camera.mirrored;
  return record;
}

Result<std::size_t> encode_camera_record(const CameraRecord& record, std::span<std::byte> bytes) {
  if (bytes.size() < kBytes) return fail(fmt::format("a camera record of {} bytes into {}", kBytes, bytes.size()));
  const auto out = bytes.first(kBytes);
  std::fill(out.begin(), out.end(), std::byte{0});
  put_name(out, kId, kRecordNameBytes, record.id);
  put_path(out, kTracks, kRecordPathBytes, record.tracks);
  // Verbatim: a target that begins with a NUL is none.
  if (record.tracking == (out[kTracks] == std::byte{0})) {
    return fail("a camera with contradictory flags and target");
  }
  RecordHeader header = record.header;
  header.kind = RecordKind::camera_parameters;
  encode_record_header(header, out);
  put_pose(out, kPose, record.pose);
  put_pose(out, kMount, record.mount);
  put(out, kPan, record.pan);
  put(out, kTilt, record.tilt);
  put(out, kFocalDistance, record.focal_distance);
  put(out, kFovy, record.fovy);
  put(out, kFlags, flags_of(record));
  return kBytes;
}

Result<CameraRecord> decode_camera_record(std::span<const std::byte> bytes) {
  const auto header = decode_record_header(bytes);
  if (!header) return std::unexpected(header.error());
  if (header->kind != RecordKind::camera_parameters) {
    return fail(fmt::format("a record of kind {}, not of a camera", static_cast<int>(header->kind)));
  }
  if (bytes.size() != kBytes) return fail(fmt::format("a camera record of {} bytes; it has {}", bytes.size(), kBytes));
  auto id = get_text(bytes, kId, kRecordNameBytes);
  if (!id) return std::unexpected(id.error());
  auto tracks = get_text(bytes, kTracks, kRecordPathBytes);
  if (!tracks) return std::unexpected(tracks.error());
  CameraRecord record;
  record.header = *header;
  record.id = std::move(*id);
  record.tracks = std::move(*tracks);
  record.pose = get_pose(bytes, kPose);
  record.mount = get_pose(bytes, kMount);
  record.pan = get<double>(bytes, kPan);
  record.tilt = get<double>(bytes, kTilt);
  record.focal_distance = get<double>(bytes, kFocalDistance);
  record.fovy = get<double>(bytes, kFovy);
  if (const auto ok = get_flags(bytes, record); !ok) return std::unexpected(ok.error());
  return record;
}

}  // namespace cellmirror
