// Pictures against those of VTK's ray caster on the processor: the same volume, table, camera and step, without light.
#include <gtest/gtest.h>

#include "rt_core/volume/caster.hpp"
#include "tests/support/volume/phantoms.hpp"
#include "tests/support/volume/vtk_peer.hpp"

namespace cellmirror::volume {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;

struct PeerCase {
  std::string name;
  VolumeTable table;
  phantoms::Camera camera;
  double step_voxels = 0.5;
  bool bytes = false;
  CastQuality quality = kEvenQuality;
  double most = 2;  // mean difference over the picture, of 255
};
void PrintTo(const PeerCase& peer, std::ostream* out) { *out << peer.name; }

// Air at its borders: VTK ends at the outermost voxels' centres, the volume here half a voxel further out.
std::shared_ptr<VoxelGrid> phantom(bool bytes) {
  constexpr double kEdge_m = 0.3;
  const Eigen::Vector3d spacing(kEdge_m / 96, kEdge_m / 80, kEdge_m / 72);
  const auto value = [&](const Eigen::Vector3d& p) { return phantoms::trunk(p, kEdge_m); };
  if (!bytes) {
    auto grid = phantoms::grid_of<std::int16_t>({96, 80, 72}, spacing, value);
    grid->hounsfield = true;
    return grid;
  }
  return phantoms::grid_of<std::uint8_t>(
      {96, 80, 72}, spacing, [&](const Eigen::Vector3d& p) { return std::clamp((value(p) + 1000) / 10, 0.0, 255.0); });
}

class VtkTest : public testing::TestWithParam<PeerCase> {};

TEST_P(VtkTest, SeesTheSame) {
  if (!phantoms::vtk_is_there())
    GTEST_SKIP() << "skipped: VTK (python3-vtk9) or xvfb is not installed; ./check --peers installs them";
  const PeerCase& peer = GetParam();
  const auto grid = phantom(peer.bytes);
  Caster caster(1);
  CastRequest request;
  request.grid = grid;
  request.width = kWidth;
  request.height = kHeight;
  request.clip_from_V = phantoms::clip_from_world(peer.camera, kWidth, kHeight);
  request.settings.table = peer.table;
  request.quality = peer.quality;
  request.quality.light = false;
  request.quality.step_voxels = peer.step_voxels;
  VolumePicture sut;
  ASSERT_TRUE(caster.cast(request, sut));
  const auto range = caster.range_of(grid);
  ASSERT_TRUE(range);
  const TransferFunction transfer = make_transfer({.settings = request.settings,
                                                   .range = *range,
                                                   .hounsfield = grid->hounsfield,
                                                   .longest_edge_m = 2 * grid->half_extent_m().maxCoeff(),
                                                   .user = {}});
  const phantoms::VtkPicture expected =
      phantoms::draw_with_vtk({.grid = grid.get(),
                               .transfer = &transfer,
                               .camera = peer.camera,
                               .width = kWidth,
                               .height = kHeight,
                               .step_m = peer.step_voxels * grid->spacing_m.minCoeff()},
                              std::getenv("CELLMIRROR_SOURCE_DIR"));
  ASSERT_FALSE(expected.rgb.empty()) << expected.times;
  double sum = 0;
  std::size_t covered = 0;
  int most = 0;
  for (std::size_t i = 0; i < sut.depth.size(); ++i) {
    int difference = 0;
    for (std::size_t c = 0; c < 3; ++c) difference += std::abs(sut.rgba[4 * i + c] - expected.rgb[3 * i + c]);
    covered += sut.rgba[4 * i + 3] > 0 || expected.rgb[3 * i] > 0 ? 1U : 0U;
    sum += difference / 3.0;
    most = std::max(most, difference / 3);
  }
  const double mean = sum / static_cast<double>(sut.depth.size());
  const double of_covered = sum / static_cast<double>(std::max<std::size_t>(covered, 1));
  fmt::print("{}: mean difference {:.2f} of 255 ({:.2f} over the {:.1f} % that are covered), most {}\n", peer.name,
             mean, of_covered, 100.0 * static_cast<double>(covered) / static_cast<double>(sut.depth.size()), most);
  EXPECT_GT(covered, sut.depth.size() / 5);
  EXPECT_LT(mean, peer.most);
}

const phantoms::Camera kPerspective{.from = Eigen::Vector3d(0.35, -0.6, 0.2), .near_m = 0.1, .far_m = 2};
const phantoms::Camera kParallel{.from = Eigen::Vector3d(-0.3, -0.5, -0.1), .height_m = 0.4, .near_m = 0.1, .far_m = 2};

INSTANTIATE_TEST_SUITE_P(All, VtkTest,
                         testing::Values(PeerCase{"medical", VolumeTable::medical, kPerspective},
                                         PeerCase{"medical_parallel", VolumeTable::medical, kParallel},
                                         PeerCase{"medical_long_steps", VolumeTable::medical, kPerspective, 0.5, false,
                                                  kFullQuality},
                                         PeerCase{"linear", VolumeTable::linear, kPerspective},
                                         PeerCase{"linear_bytes", VolumeTable::linear, kPerspective, 0.5, true},
                                         PeerCase{"exponential", VolumeTable::exponential, kParallel},
                                         PeerCase{"rainbow", VolumeTable::rainbow, kPerspective}),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace cellmirror::volume
