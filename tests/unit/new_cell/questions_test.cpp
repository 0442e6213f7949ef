#include "app/new_cell/questions.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "app/new_cell/new_cell.hpp"

namespace cellmirror::app {
namespace {

using testing::HasSubstr;
using testing::Not;

// A file that is there wherever the tests run.
constexpr const char* kFile = "/proc/self/cmdline";

TEST(Questions, EmptyAnswersTakeTheDefaults) {
  NewCellRequest request;
  std::istringstream in(std::string(kFile) + "\n\n\n\n\n");
  std::ostringstream out;
  ASSERT_TRUE(ask_for_rest(request, {}, in, out)) << out.str();
  EXPECT_EQ(request.urdf, kFile);
  EXPECT_EQ(request.xyz_m, (std::array<double, 3>{0, 0, 0}));
  EXPECT_TRUE(request.eds.empty() && request.nodes.empty() && request.dbc.empty());
  EXPECT_FALSE(request.topic);
  EXPECT_THAT(out.str(), Not(HasSubstr("CAN channel"))) << "there is no bus";
}

TEST(Questions, AnAnswerThatMakesNoSenseIsAskedForAgainButNotForEver) {
  NewCellRequest request;
  request.urdf = kFile;
  std::istringstream in("1 2\n1 2 x\n1 2 3\n");
  std::ostringstream out;
  EXPECT_FALSE(ask_for_rest(request, {}, in, out)) << "the input ends";
  EXPECT_EQ(request.xyz_m, (std::array<double, 3>{1, 2, 3}));
  EXPECT_THAT(out.str(), HasSubstr("\"x\" is not a number"));
  std::istringstream stubborn("x\nx\nx\nx\nx\nx\n");
  EXPECT_FALSE(ask_for_rest(request, {}, stubborn, out));
}

NewCellRequest sound() {
  NewCellRequest request;
  request.folder = "mine";
  request.urdf = "arm.urdf";
  return request;
}

TEST(NewCellRequest, IsCheckedBeforeAnythingIsRead) {
  EXPECT_TRUE(check_request(sound()));
  NewCellRequest request = sound();
  request.folder = "a b";
  EXPECT_THAT(check_request(request).error().what, HasSubstr("not a name"));
  request = sound();
  request.nodes = {1, 128};
  EXPECT_THAT(check_request(request).error().what, HasSubstr("128 is not a node id"));
  request = sound();
  request.xyz_m[1] = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(check_request(request));
  request = sound();
  request.topic = "rt/a b";
  EXPECT_FALSE(check_request(request));
}

}  // namespace
}  // namespace cellmirror::app
