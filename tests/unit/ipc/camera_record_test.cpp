#include "ipc/wire/camera_record.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>

#include "tests/unit/ipc/golden_bytes.hpp"

namespace cellmirror {
namespace {

using test::Bytes;
using test::place;

constexpr std::size_t kBytes = 384;

// docs/messages.md: a mirrored camera that tracks.
Bytes golden() {
  Bytes bytes(kBytes, std::byte{0});
  place(bytes, 0, "CMIR");
  place(bytes, 4, {0x01, 0x00, 0x04, 0x00, 0x80, 0x01});  // version 1, kind 4, 384 bytes
  place(bytes, 16, {0x07});                               // sequence
  place(bytes, 24, {0x00, 0xCA, 0x9A, 0x3B});             // 1,000,000,000 ns
  place(bytes, 32, {0x00, 0x00, 0x2A, 0x36, 0xFE, 0x9C, 0x97, 0x17});
  place(bytes, 40, "UMG_Kamera_1");
  place(bytes, 104, "Gantry.J_2.Hand");
  place(bytes, 232, {0, 0, 0, 0, 0, 0, 0xF0, 0x3F});  // pose: x 1
  place(bytes, 240, {0, 0, 0, 0, 0, 0, 0x00, 0xC0});  // y -2
  place(bytes, 248, {0, 0, 0, 0, 0, 0, 0xE0, 0x3F});  // z 0.5
  place(bytes, 256, {0, 0, 0, 0, 0, 0, 0xF0, 0x3F});  // quaternion x 1: half a turn about x
  place(bytes, 288, {0, 0, 0, 0, 0, 0, 0x08, 0x40});  // mount: x 3
  place(bytes, 336, {0, 0, 0, 0, 0, 0, 0xF0, 0x3F});  // quaternion w 1
  place(bytes, 344, {0, 0, 0, 0, 0, 0, 0xD0, 0x3F});  // pan 0.25
  place(bytes, 352, {0, 0, 0, 0, 0, 0, 0xE0, 0xBF});  // tilt -0.5
  place(bytes, 360, {0, 0, 0, 0, 0, 0, 0x14, 0x40});  // distance 5
  place(bytes, 368, {0, 0, 0, 0, 0, 0, 0xC0, 0x3F});  // fovy 0.125
  place(bytes, 376, {0x03});                          // tracking, mirrored
  return bytes;
}

CameraState camera() {
  CameraState made;
  made.name = "UMG_Kamera_1";
  made.tracks = "Gantry.J_2.Hand";
  made.X_WC.translation() = Eigen::Vector3d(1, -2, 0.5);
  made.X_WC.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
  made.X_WM.translation() = Eigen::Vector3d(3, 0, 0);
  made.pan_rad = 0.25;
  made.tilt_rad = -0.5;
  made.focal_distance_m = 5;
  made.fovy_rad = 0.125;
  made.tracking = made.mirrored = true;
  return made;
}

CameraRecord stamped(CameraRecord record) {
  record.header.sequence = 7;
  record.header.wall_time_ns = 1'700'000'000'000'000'000;
  return record;
}

Bytes encoded(const CameraRecord& record) {
  Bytes bytes(kMaxRecordBytes, std::byte{0xEE});
  const auto length = encode_camera_record(record, bytes);
  EXPECT_TRUE(length) << length.error().text();
  bytes.resize(length.value_or(0));
  return bytes;
}

TEST(CameraRecord, IsEncodedAsDocumented) {
  EXPECT_EQ(encoded(stamped(camera_record_of(camera(), Timestamp{1'000'000'000}))), golden());
}

TEST(CameraRecord, IsDecodedAsDocumented) {
  const auto sut = decode_camera_record(golden());
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_EQ(sut->header.kind, RecordKind::camera_parameters);
  EXPECT_EQ(sut->header.sequence, 7U);
  EXPECT_EQ(sut->header.time_ns, 1'000'000'000);
  EXPECT_EQ(sut->id, "UMG_Kamera_1");
  EXPECT_EQ(sut->tracks, "Gantry.J_2.Hand");
  EXPECT_EQ(sut->pose.position, (PointRecord{1, -2, 0.5}));
  EXPECT_EQ(sut->pose.quaternion, (std::array<double, 4>{1, 0, 0, 0}));
  EXPECT_EQ(sut->mount.position, (PointRecord{3, 0, 0}));
  EXPECT_EQ(sut->mount.quaternion, (std::array<double, 4>{0, 0, 0, 1}));
  EXPECT_EQ(sut->pan, 0.25);
  EXPECT_EQ(sut->tilt, -0.5);
  EXPECT_EQ(sut->focal_distance, 5);
  EXPECT_EQ(sut->fovy, 0.125);
  EXPECT_TRUE(sut->tracking);
  EXPECT_TRUE(sut->mirrored);
}

TEST(CameraRecord, OneThatTracksNothingNamesNothing) {
  CameraState idle = camera();
  idle.tracking = false;  // its target may be gone, its name not
  const auto sut = decode_camera_record(encoded(camera_record_of(idle, {})));
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_EQ(sut->tracks, "");
  EXPECT_FALSE(sut->tracking);
}

TEST(CameraRecord, LongPathsKeepBothEnds) {
  CameraState deep = camera();
  deep.tracks = std::string(200, 'a') + ".Hand";
  const auto sut = decode_camera_record(encoded(camera_record_of(deep, {})));
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_EQ(sut->tracks, std::string(63, 'a') + "..." + std::string(56, 'a') + ".Hand");
}

TEST(CameraRecord, RefusesWhatTheEncoderWouldNotWrite) {
  struct Damage {
    std::size_t offset;
    int value;
    const char* what;
  };
  const Damage damages[] = {{6, 2, "another kind"},
                            {8, 0, "length"},
                            {90, 'x', "behind the id's NUL"},
                            {200, 'x', "behind the path"},
                            {376, 7, "a flag"},
                            {376, 2, "a target, but no tracking"},
                            {379, 1, "a flag"},
                            {380, 1, "reserved"}};
  for (const Damage& damage : damages) {
    Bytes bytes = golden();
    bytes[damage.offset] = static_cast<std::byte>(damage.value);
    EXPECT_FALSE(decode_camera_record(bytes)) << damage.what;
  }
  Bytes untargeted = golden();
  std::fill_n(untargeted.begin() + 104, 128, std::byte{0});
  EXPECT_FALSE(decode_camera_record(untargeted)) << "tracking, but nothing";
  for (std::size_t length = 0; length < kBytes + 2; ++length) {
    if (length == kBytes) continue;
    Bytes other = golden();
    other.resize(length);
    if (length >= 10) place(other, 8, {static_cast<int>(length & 0xFF), static_cast<int>(length >> 8)});
    EXPECT_FALSE(decode_camera_record(other)) << length;
  }
}

TEST(CameraRecord, EncoderRefusesContradictionsAndTooLittleRoom) {
  CameraRecord record = camera_record_of(camera(), {});
  Bytes bytes(kBytes - 1);
  EXPECT_FALSE(encode_camera_record(record, bytes));
  bytes.resize(kBytes);
  record.tracks.clear();
  EXPECT_FALSE(encode_camera_record(record, bytes));
}

}  // namespace
}  // namespace cellmirror
