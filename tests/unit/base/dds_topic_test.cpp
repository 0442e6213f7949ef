#include "rt_core/base/dds_topic.hpp"

#include <gtest/gtest.h>

namespace cellmirror {
namespace {

TEST(DdsTopic, ALeadingSlashIsRos2sAndGetsItsPrefix) {
  EXPECT_EQ(dds_topic("/joint_states"), "rt/joint_states");
  EXPECT_EQ(dds_topic("/left/joint_states"), "rt/left/joint_states");
  EXPECT_EQ(dds_topic("rt/joint_states"), "rt/joint_states");
  EXPECT_EQ(dds_topic("MyTopic"), "MyTopic");
  EXPECT_EQ(dds_topic(""), "");
}

TEST(DdsTopic, KnowsTopicsOfRos2) {
  for (const char* name : {"rt/joint_states", "rt/a/b_1/C", "rt/_x"}) EXPECT_TRUE(is_ros_topic(name)) << name;
  for (const char* name :
       {"", "rt", "rt/", "rta/b", "rt//b", "rt/b/", "rt/1b", "rt/b c", "rt/b\"", "joint_states", "rq/b"})
    EXPECT_FALSE(is_ros_topic(name)) << name;
}

}  // namespace
}  // namespace cellmirror
