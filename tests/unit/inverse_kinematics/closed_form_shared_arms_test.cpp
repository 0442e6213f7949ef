// The arms of the shared data, from their URDF.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "closed_form_checks.hpp"
#include "config/component_files.hpp"
#include "config/file_finder.hpp"
#include "rt_core/cell/robot_chain.hpp"

namespace cellmirror::inverse_kinematics {
namespace {

using namespace test;

std::filesystem::path robots_folder() {
  if (const char* folder = std::getenv("CELLMIRROR_SHARED_DATA")) return std::filesystem::path(folder) / "robots";
  const char* source = std::getenv("CELLMIRROR_SOURCE_DIR");
  return std::filesystem::path(source != nullptr ? source : ".") / "../shared/data/robots";
}

struct SharedArm {
  const char* name;
  const char* base;
  const char* tip;
  bool redundant;
};

class ClosedFormSharedArms : public testing::TestWithParam<SharedArm> {};

TEST_P(ClosedFormSharedArms, FindsEveryRandomPostureAgain) {
  const SharedArm& arm = GetParam();
  const auto file = robots_folder() / arm.name / (std::string(arm.name) + ".urdf");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "skipped: no " << file << " on this machine";
  Diagnostics diagnostics;
  const auto component = read_component_file(file, AnyFile{}, diagnostics);
  ASSERT_TRUE(component);
  const auto chain = chain_between(*component, arm.base, arm.tip);
  ASSERT_TRUE(chain) << chain.error().what;
  const auto sut = arm.redundant ? ClosedForm::analyse_redundant(*chain) : ClosedForm::analyse(*chain);
  ASSERT_TRUE(sut);
  EXPECT_TRUE(sut->exact()) << sut->deviation();
  EXPECT_EQ(arm.redundant, ClosedForm::analyse(*chain) == std::nullopt);
  expect_all_found(*sut, *chain, 10'000, 21);
}

INSTANTIATE_TEST_SUITE_P(All, ClosedFormSharedArms,
                         testing::Values(SharedArm{"ur5e", "base_link", "tool0", false},
                                         SharedArm{"kr6r900sixx", "base_link", "tool0", false},
                                         SharedArm{"irb120", "base_link", "tool0", false},
                                         SharedArm{"lrmate200id", "base_link", "tool0", false},
                                         SharedArm{"tx90", "base_link", "tool0", false},
                                         SharedArm{"panda", "panda_link0", "panda_link8", true},
                                         SharedArm{"sia20d", "base_link", "tool0", true}),
                         [](const auto& arm) { return std::string(arm.param.name); });

}  // namespace
}  // namespace cellmirror::inverse_kinematics
