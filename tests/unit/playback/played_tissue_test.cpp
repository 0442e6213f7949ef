// Deformable objects of a recording put together again: shapes and places, cuts, what is not recorded.
#include "app/playback/played_tissue.hpp"

#include <gtest/gtest.h>

#include "app/recording_layout/recording_names.hpp"
#include "tests/unit/recorder/tissue_parts.hpp"

namespace cellmirror::app {
namespace {

class PlayedTissueTest : public testing::Test {
 protected:
  PlayedTissueTest() {
    auto rest = std::make_shared<TissueView>();
    rest->surfaces = {test::square("liver.mpo", {0, 0, 0}), test::square("duct.mpo", {1, 0, 0})};
    rest->surfaces[0].look = std::make_shared<const MeshAppearance>();
    look_ = rest->surfaces[0].look;
    sut_.set_rest(rest);
  }

  void take(const TissueSurface& surface, std::uint32_t revision, bool with_shape) {
    std::vector<std::byte> bytes;
    ASSERT_TRUE(encode_surface({.step = ++step_, .time = Timestamp{1}, .revision = revision, .has_shape = with_shape},
                               surface, bytes));
    sut_.take(channel(kTissueEncoding, "/cellmirror/tissue/liver"), bytes);
  }
  static mcap::Channel channel(std::string_view encoding, std::string topic) {
    return {.id = 1, .schema = 0, .topic = std::move(topic), .encoding = std::string(encoding), .metadata = {}};
  }
  std::shared_ptr<const TissueView> shown() {
    sut_.publish();
    return sut_.view();
  }

  PlayedTissue sut_;
  std::shared_ptr<const MeshAppearance> look_;
  std::uint64_t step_ = 0;
};

TEST_F(PlayedTissueTest, WhatIsNotRecordedIsAsTheCellHasIt) {
  const auto view = shown();
  ASSERT_TRUE(view);
  EXPECT_EQ(view->surfaces.size(), 2U);
  EXPECT_EQ(shown(), view) << "nothing has changed";
  PlayedTissue without;
  without.publish();
  EXPECT_FALSE(without.view());
}

TEST_F(PlayedTissueTest, ASurfaceMovesAndIsCutAndKeepsItsLook) {
  TissueSurface liver = test::square("liver.mpo", {0, 0, 0.5F});
  take(liver, 1, true);
  const auto first = shown();
  EXPECT_NEAR(first->surfaces[0].vertices[0].z(), 0.499F, 1e-4F);
  EXPECT_EQ(first->surfaces[0].look, look_);
  EXPECT_EQ(first->surfaces[1].vertices[0].x(), 0.9F);
  liver.vertices[0].z() = 0.6F;
  take(liver, 1, false);
  const auto moved = shown();
  EXPECT_NEAR(moved->surfaces[0].vertices[0].z(), 0.6F, 1e-4F);
  EXPECT_EQ(moved->surfaces[0].topology, first->surfaces[0].topology) << "the page keeps the shape";
  EXPECT_GT(moved->step, first->step);
  test::cut(liver);
  take(liver, 2, true);
  EXPECT_EQ(shown()->surfaces[0].topology->triangles.size(), 1U);
}

TEST_F(PlayedTissueTest, PlacesOfAShapeThatIsMissingAreLeftOut) {
  TissueSurface liver = test::square("liver.mpo", {0, 0, 0.5F});
  take(liver, 1, true);
  const auto first = shown();
  liver.vertices[0].z() = 0.6F;
  take(liver, 2, false);
  EXPECT_NEAR(shown()->surfaces[0].vertices[0].z(), 0.499F, 1e-4F) << "the message with the shape was lost";
  EXPECT_EQ(sut_.refused(), 1U);
  sut_.begin();
  EXPECT_NEAR(shown()->surfaces[0].vertices[0].z(), -0.001F, 1e-4F) << "of another time nothing is known yet";
}

TEST_F(PlayedTissueTest, ClipsAndPoolAreShown) {
  TissueView view;
  view.clips = {test::clip(0.5)};
  view.pool.present = true;
  std::vector<std::byte> bytes;
  encode_tissue_effects({.step = 1, .time = Timestamp{1}, .revision = 1, .has_shape = true}, view, bytes);
  sut_.take(channel(kTissueEffectsEncoding, "/cellmirror/tissue_effects"), bytes);
  EXPECT_EQ(shown()->clips.size(), 1U);
  EXPECT_TRUE(shown()->pool.present);
  EXPECT_EQ(shown()->surfaces.size(), 2U);
}

TEST_F(PlayedTissueTest, AnyBytesAreCountedAndLeftOut) {
  const auto of_liver = channel(kTissueEncoding, "/cellmirror/tissue/liver");
  sut_.take(of_liver, {});
  std::vector<std::byte> bytes(300, std::byte{1});
  sut_.take(of_liver, bytes);
  EXPECT_EQ(shown()->surfaces[0].vertices[2].x(), 0.1F);
  EXPECT_GE(sut_.refused(), 2U);
  for (std::size_t i = 0; i < 2 * PlayedTissue::kMostChannels; ++i)
    sut_.take(channel(kTissueEncoding, "/" + std::to_string(i)), bytes);
  EXPECT_EQ(shown()->surfaces.size(), 2U);
}

}  // namespace
}  // namespace cellmirror::app
