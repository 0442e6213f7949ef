// What contacts leave of the motion of joints.
#include "drivers/can/cia402/device/contact_bounds.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace cellmirror::can {
namespace {

constexpr double kFree = std::numeric_limits<double>::infinity();

RobotContacts contact(double a, double b) {
  RobotContacts contacts;
  contacts.count = 1;
  contacts.rates[0][0] = a;
  contacts.rates[0][1] = b;
  return contacts;
}

TEST(ContactBounds, NothingTouches) {
  const JointBounds bounds = contact_bounds({}, {});
  EXPECT_EQ(bounds[0].lower, -kFree);
  EXPECT_EQ(bounds[0].upper, kFree);
}

TEST(ContactBounds, OnlyMotionThatDeepensIsBlocked) {
  const JointBounds bounds = contact_bounds(contact(0.5, -0.5), {});
  EXPECT_EQ(bounds[0].lower, -kFree);
  EXPECT_EQ(bounds[0].upper, 0);
  EXPECT_EQ(bounds[1].lower, 0);
  EXPECT_EQ(bounds[1].upper, kFree);
  EXPECT_EQ(bounds[2].upper, kFree) << "has no share in the contact";
}

// Straight away from a wall some joints of an arm turn towards it.
TEST(ContactBounds, AJointMayDeepenWhatOthersLeave) {
  JointVelocities velocities{};
  velocities[1] = -2;  // leaves with 1 m/s
  const JointBounds bounds = contact_bounds(contact(0.25, 0.5), velocities);
  EXPECT_DOUBLE_EQ(bounds[0].upper, 4);
  EXPECT_EQ(bounds[1].upper, 0);
}

TEST(ContactBounds, NoJointIsPushed) {
  JointVelocities velocities{};
  velocities[0] = 2;
  velocities[1] = 2;
  const JointBounds bounds = contact_bounds(contact(0.5, 0.5), velocities);
  EXPECT_EQ(bounds[0].upper, 0);
  EXPECT_EQ(bounds[1].upper, 0);
}

TEST(ContactBounds, SmallSharesAreLeftOut) {
  const JointBounds bounds = contact_bounds(contact(0.5, 0.004), {});
  EXPECT_EQ(bounds[1].upper, kFree);
}

TEST(ContactBounds, SeveralContacts) {
  RobotContacts contacts = contact(0.5, 0);
  contacts.count = 2;
  contacts.rates[1][0] = -0.5;
  const JointBounds bounds = contact_bounds(contacts, {});
  EXPECT_EQ(bounds[0].lower, 0);
  EXPECT_EQ(bounds[0].upper, 0);
}

}  // namespace
}  // namespace cellmirror::can
