// One renderer for all tests of a program, and small pictures of it.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "drivers/display/renderer.hpp"
#include "tests/unit/display/picture_probe.hpp"
#include "tests/unit/display/test_scenes.hpp"

namespace cellmirror::display {

class RendererTest : public testing::Test {
 protected:
  static constexpr int kEdge = 200;  // pixels each way; parallel views show 4 m: 50 pixels a metre

  static Renderer* shared() {
    static const auto kRenderer = Renderer::create();
    return kRenderer ? kRenderer->get() : nullptr;
  }

  void SetUp() override {
    if (shared() == nullptr) GTEST_SKIP() << "skipped: no OpenGL without a display here";
  }

  // Looks along +y (level) or down (from above); the origin is in the middle.
  static Pane level() { return parallel({0, -10, 0}, Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ()); }
  static Pane from_above() { return parallel({0, 0, 10}, Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY()); }
  static Pane parallel(const Eigen::Vector3d& from, const Eigen::Vector3d& right, const Eigen::Vector3d& up) {
    Pane pane;
    pane.eye.X_WE.translation() = from;
    pane.eye.X_WE.linear() << right, up, right.cross(up);
    pane.eye.height_m = 4;
    pane.eye.far_distance = 50;
    return pane;
  }

  static Image picture(const Scene& scene, const Pane& pane = level()) {
    return picture(scene, std::vector<Pane>{pane});
  }
  static Image picture(const Scene& scene, const std::vector<Pane>& panes) {
    Image image;
    const Result<void> drawn = shared()->draw(scene, panes, kEdge, kEdge, image);
    EXPECT_TRUE(drawn) << (drawn ? "" : drawn.error().text());
    return image;
  }
  static std::vector<std::uint32_t> objects(const Scene& scene, const Pane& pane = level()) {
    std::vector<std::uint32_t> numbers;
    EXPECT_TRUE(shared()->objects(scene, std::vector<Pane>{pane}, kEdge, kEdge, numbers));
    return numbers;
  }
  static void set(Scene& scene, DisplayMode mode) { scene.modes.set(static_cast<std::size_t>(mode)); }
  static Region around(int x, int y, int reach = 5) { return {x - reach, y - reach, 2 * reach + 1, 2 * reach + 1}; }

  // A sheet of 2 m x 2 m that shows its front to +y and its back to who looks along +y.
  static std::shared_ptr<const geometry::TriangleMesh> sheet_facing_away() {
    auto mesh = std::make_shared<geometry::TriangleMesh>();
    mesh->vertices = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}};
    mesh->triangles = {{0, 2, 1}, {0, 3, 2}};
    return mesh;
  }
};

}  // namespace cellmirror::display
