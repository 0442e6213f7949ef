// Lines of a width in pixels, as triangles with soft edges: OpenGL's core profile has only thin ones. Private to this
// folder; no OpenGL.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "drivers/display/internal/view_transform.hpp"

namespace cellmirror::display {

struct RibbonVertex {
  std::array<float, 3> place;  // normalized device coordinates
  std::array<std::uint8_t, 4> rgba;
  std::array<float, 4> shape;  // pixels across, half the width, pixels along, period of dashes (0: none);
                               // of a glow -1 to 1 across, -1, -1 to 1 along, 0
};

class Ribbons {
 public:
  static constexpr std::size_t kMostPieces = 200'000;  // what is beyond is left out

  struct Style {
    Colour rgba_from{};
    Colour rgba_to{};
    float width_px = 1.5F;
    bool dashed = false;
  };

  void clear();
  // Points in W. What is not finite, behind the eye or beside the picture is left out.
  void line(const ViewTransform& view, const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Style& style);
  // A disc of light that gets paler outwards.
  void glow(const ViewTransform& view, const Eigen::Vector3d& centre, double radius_px, const Colour& rgba);
  [[nodiscard]] const std::vector<RibbonVertex>& vertices() const { return vertices_; }
  [[nodiscard]] const std::vector<std::uint32_t>& indices() const { return indices_; }
  [[nodiscard]] bool empty() const { return indices_.empty(); }

 private:
  void piece(const std::array<RibbonVertex, 4>& corners);

  std::vector<RibbonVertex> vertices_;
  std::vector<std::uint32_t> indices_;
};

}  // namespace cellmirror::display
