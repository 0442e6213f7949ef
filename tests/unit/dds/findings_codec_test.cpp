// Bytes of Range, WrenchStamped, DiagnosticArray and MarkerArray, written by hand from the CDR rules (see golden.hpp).
#include <gtest/gtest.h>

#include <limits>

#include "drivers/dds/diagnostic_messages.hpp"
#include "drivers/dds/image_message.hpp"
#include "drivers/dds/marker_messages.hpp"
#include "drivers/dds/range_message.hpp"
#include "drivers/dds/wrench_message.hpp"
#include "golden.hpp"

namespace cellmirror::dds::test {
namespace {

TEST(RangeCodec, WritesWhatTheStandardSays) {
  std::vector<std::byte> written;
  encode(Range{.header = {.stamp = {1, 2}, .frame_id = "u"},
               .radiation_type = kUltrasound,
               .field_of_view = 0.25F,
               .min_range = 0.5F,
               .max_range = 3.0F,
               .range = 1.0F,
               .variance = 0.0F},
         written);
  EXPECT_EQ(written, bytes({
                         0x00, 0x01, 0x00, 0x00,                          // CDR_LE, no options
                         0x01, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00,  // 0: sec, nanosec
                         0x02, 0x00, 0x00, 0x00, 'u',  0x00,              // 8: frame_id
                         0x00,                                            // 14: radiation_type
                         0x00,                                            // 15: padding
                         0x00, 0x00, 0x80, 0x3e,                          // 16: field_of_view 0.25
                         0x00, 0x00, 0x00, 0x3f,                          // 20: min_range 0.5
                         0x00, 0x00, 0x40, 0x40,                          // 24: max_range 3
                         0x00, 0x00, 0x80, 0x3f,                          // 28: range 1
                         0x00, 0x00, 0x00, 0x00,                          // 32: variance 0
                     }));
}

TEST(WrenchStampedCodec, WritesWhatTheStandardSays) {
  std::vector<std::byte> written;
  encode(WrenchStamped{.header = {.stamp = {1, 2}, .frame_id = "R/tcp"}, .force = {1, 2, -2}, .torque = {0.5, 0, 4}},
         written);
  EXPECT_EQ(written, bytes({
                         0x00, 0x01, 0x00, 0x00,                                     // CDR_LE, no options
                         0x01, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00,             // 0: sec, nanosec
                         0x06, 0x00, 0x00, 0x00, 'R',  '/',  't',  'c',  'p', 0x00,  // 8: frame_id
                         0x00, 0x00, 0x00, 0x00, 0x00, 0x00,                         // 18: padding
                         0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xf0, 0x3f,             // 24: force.x 1
                         0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x40,             // 32: force.y 2
                         0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xc0,             // 40: force.z -2
                         0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xe0, 0x3f,             // 48: torque.x 0.5
                         0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,             // 56: torque.y 0
                         0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x10, 0x40,             // 64: torque.z 4
                     }));
}

TEST(CompressedImageCodec, WritesWhatTheStandardSays) {
  const std::vector<std::uint8_t> file{0xff, 0xd8, 0xff};
  std::vector<std::byte> written;
  encode(CompressedImage{.header = {.stamp = {1, 2}, .frame_id = "C"}, .format = "jpeg", .data = file}, written);
  EXPECT_EQ(written, bytes({
                         0x00, 0x01, 0x00, 0x00,                                // CDR_LE, no options
                         0x01, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00,        // 0: sec, nanosec
                         0x02, 0x00, 0x00, 0x00, 'C',  0x00,                    // 8: frame_id
                         0x00, 0x00,                                            // 14: padding
                         0x05, 0x00, 0x00, 0x00, 'j',  'p',  'e',  'g',  0x00,  // 16: format
                         0x00, 0x00, 0x00,                                      // 25: padding
                         0x03, 0x00, 0x00, 0x00, 0xff, 0xd8, 0xff,              // 28: data
                     }));
}

// What the surroundings do to a TCP is told where anything tells of it, in the frame of /tf.
TEST(WrenchStamped, IsTheForceAtTheTcp) {
  RobotForces robot;
  robot.id = "R";
  robot.tcp_T = {{1, 2, 3}, {4, 5, 6}};
  WrenchStamped message;
  EXPECT_FALSE(fill_tcp_wrench({1, 2}, robot, message));
  robot.tcp_known = true;
  ASSERT_TRUE(fill_tcp_wrench({1, 2}, robot, message));
  EXPECT_EQ(message.header.frame_id, "R/tcp");
  EXPECT_EQ(message.force, (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(message.torque, (std::array<double, 3>{4, 5, 6}));
  robot.tcp_T.force.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(fill_tcp_wrench({1, 2}, robot, message));
}

TEST(DiagnosticArrayCodec, WritesWhatTheStandardSays) {
  std::vector<std::byte> written;
  encode(DiagnosticArray{.header = {.stamp = {1, 2}, .frame_id = ""},
                         .status = {{DiagnosticLevel::error, "n", "m", "h", {{"k", "v"}}}}},
         written);
  EXPECT_EQ(written, bytes({
                         0x00, 0x01, 0x00, 0x00,                          // CDR_LE, no options
                         0x01, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00,  // 0: sec, nanosec
                         0x01, 0x00, 0x00, 0x00, 0x00,                    // 8: frame_id, empty
                         0x00, 0x00, 0x00,                                // 13: padding
                         0x01, 0x00, 0x00, 0x00,                          // 16: one status
                         0x02, 0x00, 0x00, 0x00,                          // 20: level ERROR, and padding
                         0x02, 0x00, 0x00, 0x00, 'n',  0x00, 0x00, 0x00,  // 24: name, and padding
                         0x02, 0x00, 0x00, 0x00, 'm',  0x00, 0x00, 0x00,  // 32: message, and padding
                         0x02, 0x00, 0x00, 0x00, 'h',  0x00, 0x00, 0x00,  // 40: hardware_id, and padding
                         0x01, 0x00, 0x00, 0x00,                          // 48: one value
                         0x02, 0x00, 0x00, 0x00, 'k',  0x00, 0x00, 0x00,  // 52: key, and padding
                         0x02, 0x00, 0x00, 0x00, 'v',  0x00,              // 60: value
                     }));
}

// One marker with one point and one colour.
TEST(MarkerArrayCodec, WritesWhatTheStandardSays) {
  std::vector<std::byte> written;
  encode(MarkerArray{{Marker{.header = {.stamp = {1, 2}, .frame_id = "w"},
                             .ns = "d",
                             .id = 7,
                             .type = MarkerType::sphere_list,
                             .action = MarkerAction::add,
                             .position = {1, 0, 0},
                             .scale = {0.5, 0.5, 0.5},
                             .colour = {1, 0, 0, 0.5F},
                             .lifetime_ns = 2'000'000'003,
                             .points = {{0, -2, 0}},
                             .colours = {{0, 1, 0, 1}}}}},
         written);
  const std::vector<std::byte> golden = bytes({
      0x00, 0x01, 0x00, 0x00,                          // CDR_LE, no options
      0x01, 0x00, 0x00, 0x00,                          // 0: one marker
      0x01, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00,  // 4: sec, nanosec
      0x02, 0x00, 0x00, 0x00, 'w',  0x00, 0x00, 0x00,  // 12: frame_id, and padding
      0x02, 0x00, 0x00, 0x00, 'd',  0x00, 0x00, 0x00,  // 20: ns, and padding
      0x07, 0x00, 0x00, 0x00,                          // 28: id
      0x07, 0x00, 0x00, 0x00,                          // 32: type SPHERE_LIST
      0x00, 0x00, 0x00, 0x00,                          // 36: action ADD
      0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xf0, 0x3f,  // 40: position 1, 0, 0
      0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,  //
      0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,  //
      0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,  // 64: orientation 0, 0, 0, 1
      0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,  //
      0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,  //
      0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xf0, 0x3f,  //
      0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xe0, 0x3f,  // 96: scale 0.5, 0.5, 0.5
      0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xe0, 0x3f,  //
      0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xe0, 0x3f,  //
      0x00, 0x00, 0x80, 0x3f, 0x00, 0x00, 0x00, 0x00,  // 120: colour 1, 0, 0, 0.5
      0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x3f,  //
      0x02, 0x00, 0x00, 0x00, 0x03, 0x00, 0x00, 0x00,  // 136: lifetime, 2 s and 3 ns
      0x00, 0x00, 0x00, 0x00,                          // 144: frame_locked, and padding
      0x01, 0x00, 0x00, 0x00,                          // 148: one point
      0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,  // 152: 0, -2, 0
      0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xc0,  //
      0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,  //
      0x01, 0x00, 0x00, 0x00,                          // 176: one colour
      0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x80, 0x3f,  // 180: 0, 1, 0, 1
      0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x80, 0x3f,  //
      0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,  // 196: texture_resource, and padding
      0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,  // 204: texture.header.stamp
      0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,  // 212: texture.header.frame_id, and padding
      0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,  // 220: texture.format, and padding
      0x00, 0x00, 0x00, 0x00,                          // 228: texture.data
      0x00, 0x00, 0x00, 0x00,                          // 232: uv_coordinates
      0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,  // 236: text, and padding
      0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,  // 244: mesh_resource, and padding
      0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,  // 252: mesh_file.filename, and padding
      0x00, 0x00, 0x00, 0x00,                          // 260: mesh_file.data
      0x00,                                            // 264: mesh_use_embedded_materials
  });
  EXPECT_EQ(written, golden);
}

TEST(MarkerArrayCodec, LifetimesThatDoNotFitAreTheLongestThatDoes) {
  std::vector<std::byte> longest;
  std::vector<std::byte> written;
  encode(MarkerArray{{Marker{.lifetime_ns = 2'147'483'647'000'000'000}}}, longest);
  encode(MarkerArray{{Marker{.lifetime_ns = std::int64_t{1} << 62}}}, written);
  EXPECT_EQ(written, longest);
  encode(MarkerArray{{Marker{.lifetime_ns = 0}}}, longest);
  encode(MarkerArray{{Marker{.lifetime_ns = -5}}}, written);
  EXPECT_EQ(written, longest);
}

}  // namespace
}  // namespace cellmirror::dds::test
