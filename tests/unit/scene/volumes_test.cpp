// Voxel volumes in a scene: at the pose of their component, with what is in force, gone where they are hidden.
#include <gtest/gtest.h>

#include "rt_core/scene/scene_builder.hpp"
#include "tests/unit/scene/small_cell.hpp"

namespace cellmirror::scene {
namespace {

class VolumesTest : public ::testing::Test {
 protected:
  VolumesTest() {
    auto grid = std::make_shared<VoxelGrid>();
    grid->size = {2, 2, 2};
    grid->values = std::vector<std::uint8_t>(8);
    auto volume = std::make_shared<ComponentVolume>();
    volume->grid = grid;
    volume->X_CV.translation() << 0, 0, 0.1;
    volume->settings.table = VolumeTable::linear;
    volume_ = volume;
    small_.cell.volumes = {{SmallCell::table, volume}, {SmallCell::hand, volume}};
    small_.pose(0.0);
  }
  const Scene& build() {
    SceneInput input;
    input.cell = &small_.cell;
    input.poses = &small_.poses;
    input.display = &small_.display;
    input.volumes = states_ ? &*states_ : nullptr;
    input.now = Timestamp{10'000'000'000};
    sut_.build(input, scene_);
    return scene_;
  }

  SmallCell small_;
  std::shared_ptr<const ComponentVolume> volume_;
  std::optional<VolumeStates> states_;
  Scene scene_;
  SceneBuilder sut_;
};

TEST_F(VolumesTest, AreDrawnAsTheirFilesHaveThemWhereNothingElseIsKnown) {
  const Scene& scene = build();
  ASSERT_EQ(scene.volumes.size(), 2U);
  EXPECT_EQ(scene.volumes[0].grid, volume_->grid);
  EXPECT_EQ(scene.volumes[0].settings.table, VolumeTable::linear);
  EXPECT_EQ(scene.volumes[0].object, SmallCell::table + 1U);
  EXPECT_TRUE(scene.volumes[0].X_WV.translation().isApprox(Eigen::Vector3d(2, 0, 0.6)));
}

TEST_F(VolumesTest, MoveWithTheirComponents) {
  const Pose before = build().volumes[1].X_WV;
  small_.pose(0.5);
  const Pose after = build().volumes[1].X_WV;
  EXPECT_TRUE(after.isApprox(small_.poses.X_WN[SmallCell::hand] * volume_->X_CV));
  EXPECT_FALSE(after.isApprox(before));
  EXPECT_EQ(scene_.volumes[0].X_WV.translation().z(), 0.6) << "the other stays";
}

TEST_F(VolumesTest, HaveWhatIsInForceByName) {
  states_.emplace(2);
  (*states_)[0].name = "Arm.J_1.Hand";  // not in the order of the cell
  (*states_)[0].settings.table = VolumeTable::rainbow;
  (*states_)[0].tables_revision = 7;
  (*states_)[0].user_tables[1] = std::make_shared<const VolumeUserTable>();
  (*states_)[1].name = "Nothing";
  const Scene& scene = build();
  EXPECT_EQ(scene.volumes[1].settings.table, VolumeTable::rainbow);
  EXPECT_EQ(scene.volumes[1].tables_revision, 7U);
  EXPECT_EQ(scene.volumes[1].user_tables, (*states_)[0].user_tables);
  EXPECT_EQ(scene.volumes[0].settings.table, VolumeTable::linear) << "no state: as the file has it";
}

TEST_F(VolumesTest, HiddenOnesAreNotInTheScene) {
  small_.cell.visible[SmallCell::table] = 0;
  small_.cell.revision = 2;
  const Scene& scene = build();
  ASSERT_EQ(scene.volumes.size(), 1U);
  EXPECT_EQ(scene.volumes[0].object, SmallCell::hand + 1U);
}

}  // namespace
}  // namespace cellmirror::scene
