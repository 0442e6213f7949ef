// The organs of the trainer cell: as large as a step on one processor allows, and at rest until somebody touches them.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <set>
#include <string>

#include "config/cell_file.hpp"
#include "config/clip_file.hpp"
#include "rt_core/tissue/world.hpp"

namespace cellmirror {
namespace {

constexpr std::uint32_t kMostElements = 8000;
constexpr std::uint32_t kLargeObject = 1000;  // elements

std::filesystem::path cell_file() {
  const char* given = std::getenv("CELLMIRROR_SOURCE_DIR");
  const auto here = std::filesystem::path(__FILE__).parent_path();
  const auto source = given != nullptr ? std::filesystem::path(given) : here.parent_path().parent_path().parent_path();
  return source / "config/cells/trainer/cell.toml";
}

struct TrainerCell : testing::Test {
  TrainerCell() : loaded(load_cell(cell_file(), diagnostics)) {}

  tissue::World world() const {
    auto made = tissue::World::make(loaded->tissue.objects, loaded->tissue.connections);
    EXPECT_TRUE(made) << made.error().what << "; " << made.error().remedy;
    return *std::move(made);
  }
  static TissueState state_of(const tissue::World& world) {
    TissueState state;
    world.describe(state);
    return state;
  }
  Diagnostics diagnostics;
  std::optional<LoadedCell> loaded;
};

TEST_F(TrainerCell, IsReadWithoutAWord) {
  ASSERT_TRUE(loaded) << diagnostics.text();
  EXPECT_TRUE(diagnostics.all().empty()) << diagnostics.text();
  std::set<std::string> names;
  for (const tissue::ObjectDescription& object : loaded->tissue.objects) names.insert(object.name);
  EXPECT_EQ(names, (std::set<std::string>{"liver.mpo", "gallbladder.mpo", "cystic_duct.mpo", "cystic_artery.mpo"}));
}

TEST_F(TrainerCell, FitsIntoAStep) {
  ASSERT_TRUE(loaded) << diagnostics.text();
  const TissueState state = state_of(world());
  std::uint32_t elements = 0;
  for (const TissueObjectState& object : state.objects) {
    elements += object.elements;
    EXPECT_LE(object.substeps, 2U) << object.name;
    // Vessels take less time and swing as if they weighed more.
    EXPECT_LT(object.added_mass_share, object.elements > kLargeObject ? 0.01 : 4.0) << object.name;
    EXPECT_EQ(object.parts, 1U) << object.name;
  }
  EXPECT_GT(elements, 3500U);  // fewer, and folds of the liver no longer show
  EXPECT_LE(elements, kMostElements);
}

TEST_F(TrainerCell, HasAnArteryADuctAPoolAndAdhesions) {
  ASSERT_TRUE(loaded) << diagnostics.text();
  const tissue::World made = world();
  const TissueState state = state_of(made);
  std::set<std::string> vessels;
  for (const TissueVesselState& vessel : state.vessels) vessels.insert(vessel.name);
  EXPECT_EQ(vessels, (std::set<std::string>{"cystic_artery", "cystic_duct"}));
  EXPECT_GE(state.connections, 5U);
  TissueView view;
  made.view(view, false);
  EXPECT_TRUE(view.pool.present);
}

TEST_F(TrainerCell, RestsUntilItIsTouched) {
  ASSERT_TRUE(loaded) << diagnostics.text();
  tissue::World sut = world();
  TissueView before;
  sut.view(before, false);
  for (int i = 0; i < 1000; ++i) sut.step({.time = Timestamp{i * 1'000'000}, .instruments = {}, .bodies = {}});
  TissueView after;
  sut.view(after, false);
  for (std::size_t i = 0; i < before.surfaces.size(); ++i) {
    float farthest = 0;
    for (std::size_t v = 0; v < before.surfaces[i].vertices.size(); ++v)
      farthest = std::max(farthest, (after.surfaces[i].vertices[v] - before.surfaces[i].vertices[v]).norm());
    EXPECT_LT(farthest, 0.001F) << before.surfaces[i].name;
  }
  const TissueState state = state_of(sut);
  EXPECT_TRUE(state.events.empty());
  EXPECT_EQ(state.connections_torn, 0U);
}

TEST_F(TrainerCell, HasAClip) {
  const auto home = KismetHome::open(cell_file().parent_path());
  ASSERT_TRUE(home);
  const auto clip = load_clip(*home, "clip.mpo");
  ASSERT_TRUE(clip) << clip.error().what;
  EXPECT_NEAR(clip->length_m, 0.009, 1e-6);
}

}  // namespace
}  // namespace cellmirror
