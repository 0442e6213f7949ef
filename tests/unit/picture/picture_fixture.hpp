// Small pictures of the cells that come with the project, as SCRIPT's display state wants them.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/cell_file.hpp"
#include "drivers/display/renderer.hpp"
#include "rt_core/cell/view.hpp"
#include "rt_core/scene/panes.hpp"
#include "rt_core/scene/scene_builder.hpp"
#include "tests/unit/display/picture_probe.hpp"

namespace cellmirror::scene {

inline std::filesystem::path source_folder() {
  const char* folder = std::getenv("CELLMIRROR_SOURCE_DIR");
  return folder != nullptr ? std::filesystem::path(folder) : std::filesystem::current_path();
}

struct ShownCell {
  explicit ShownCell(LoadedCell cell_file)
      : loaded(std::move(cell_file)), cell(loaded.cell.compile()), q(loaded.cell.start_positions()) {}
  LoadedCell loaded;
  std::shared_ptr<const CompiledCell> cell;
  std::vector<JointValues> q;
};

// Read once a program.
inline const ShownCell& shown_cell(const std::string& name) {
  static std::map<std::string, std::unique_ptr<ShownCell>> cells;
  std::unique_ptr<ShownCell>& cell = cells[name];
  if (cell) return *cell;
  Diagnostics diagnostics;
  auto loaded = load_cell(source_folder() / "config/cells" / name / "cell.toml", diagnostics);
  if (!loaded) throw std::runtime_error(diagnostics.text());
  cell = std::make_unique<ShownCell>(*std::move(loaded));
  return *cell;
}

// Which pixels show something whose name begins so.
struct Mask {
  std::vector<bool> in;
  std::size_t count = 0;
};

class PictureTest : public ::testing::Test {
 protected:
  static constexpr int kWidth = 240;
  static constexpr int kHeight = 180;

  static display::Renderer* renderer() {
    static const auto kRenderer = display::Renderer::create();
    return kRenderer ? kRenderer->get() : nullptr;
  }

  void SetUp() override {
    if (renderer() == nullptr) GTEST_SKIP() << "skipped: no OpenGL without a display here";
    show("transfer_cell");
    // The second arm in front of the test bench.
    View& view = state_.views[0].view;
    view.viewpoint = {2.6, -4.4, 1.7};
    view.lookpoint = {2.0, -1.6, 0.8};
    view.opening_angle = 0.75;
    view.twist = 0;
  }

  void show(const std::string& name) {
    const ShownCell& shown = shown_cell(name);
    cell_ = shown.cell;
    q_ = shown.q;
    state_ = {};
    state_.legend = true;
    const auto views = views_of_extent(extent_of(*cell_, q_));
    for (std::size_t id = 0; id < kViews; ++id) state_.views[id].view = views[id];
    for (const CompiledCamera& camera : cell_->cameras) state_.cameras.emplace_back().name = camera.name;
    input_ = {};
    input_.now = input_.posture_time = Timestamp{10'000'000'000};
  }

  void set(DisplayMode mode, bool on = true) { state_.modes.set(static_cast<std::size_t>(mode), on); }

  const Scene& scene() {
    compute_poses(*cell_, q_, poses_);
    input_.cell = cell_.get();
    input_.poses = &poses_;
    input_.display = &state_;
    builder_.build(input_, scene_);
    return scene_;
  }
  [[nodiscard]] std::vector<Pane> panes() const {
    return panes_of_display({*cell_, poses_, state_, input_.now, updates_});
  }

  Image picture(int width = kWidth, int height = kHeight) {
    Image image;
    scene();
    const auto drawn = renderer()->draw(scene_, panes(), width, height, image);
    EXPECT_TRUE(drawn) << (drawn ? "" : drawn.error().text());
    return image;
  }

  Mask mask(std::string_view name) {
    std::vector<std::uint32_t> objects;
    scene();
    EXPECT_TRUE(renderer()->objects(scene_, panes(), kWidth, kHeight, objects));
    Mask mask;
    for (const std::uint32_t object : objects) {
      mask.in.push_back(object != 0 && (*cell_->paths)[object - 1].starts_with(name));
      mask.count += mask.in.back() ? 1U : 0U;
    }
    return mask;
  }

  [[nodiscard]] std::int32_t node(std::string_view path) const {
    const auto at = std::ranges::find(*cell_->paths, path);
    EXPECT_NE(at, cell_->paths->end()) << path;
    return static_cast<std::int32_t>(at - cell_->paths->begin());
  }
  [[nodiscard]] Eigen::Vector3d place(std::string_view path) const {
    return poses_.X_WN[static_cast<std::size_t>(node(path))].translation();
  }
  // Where a point is seen in the first pane.
  [[nodiscard]] Eigen::Vector2i pixel_of(const Eigen::Vector3d& p_W) const {
    const Pane pane = panes().front();
    const Eigen::Vector3d p_E = pane.eye.X_WE.inverse() * p_W;
    const double half =
        pane.eye.height_m > 0 ? 0.5 * pane.eye.height_m : -p_E.z() * std::tan(0.5 * pane.eye.opening_angle);
    const double scale = 0.5 * pane.height * kHeight / half;
    return {static_cast<int>((pane.left + 0.5 * pane.width) * kWidth + scale * p_E.x()),
            static_cast<int>((pane.top + 0.5 * pane.height) * kHeight - scale * p_E.y())};
  }

  // Pixels that differ, of those that the mask has (or has not).
  static std::size_t different(const Image& a, const Image& b, const Mask& mask, bool inside) {
    std::size_t count = 0;
    for (int y = 0; y < a.height; ++y) {
      for (int x = 0; x < a.width; ++x) {
        const bool in = mask.in[static_cast<std::size_t>(y * a.width + x)];
        if (in == inside && display::differ(a.pixel(x, y), b.pixel(x, y), 4)) ++count;
      }
    }
    return count;
  }
  static std::size_t count(const Image& image, const display::Region& region,
                           const std::function<bool(const std::uint8_t*)>& like) {
    std::size_t found = 0;
    for (int y = std::max(region.y, 0); y < std::min(region.y + region.height, image.height); ++y) {
      for (int x = std::max(region.x, 0); x < std::min(region.x + region.width, image.width); ++x)
        found += like(image.pixel(x, y)) ? 1U : 0U;
    }
    return found;
  }
  static display::Region around(const Eigen::Vector2i& pixel, int reach) {
    return {pixel.x() - reach, pixel.y() - reach, 2 * reach + 1, 2 * reach + 1};
  }

  std::shared_ptr<const CompiledCell> cell_;
  std::vector<JointValues> q_;
  CellPoses poses_;
  DisplayState state_;
  SceneInput input_;
  std::uint64_t updates_ = 0;
  Scene scene_;
  SceneBuilder builder_;
};

}  // namespace cellmirror::scene
