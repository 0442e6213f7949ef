#include "app/render/picture_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "app/render/picture_rate.hpp"
#include "rt_core/base/text.hpp"
#include "rt_core/ports/display_state.hpp"
#include "rt_core/ports/image.hpp"

namespace cellmirror::app {

namespace {

constexpr double kFarthest = 1e4;  // m

bool good_place(const Eigen::Vector3d& p) { return p.allFinite() && p.cwiseAbs().maxCoeff() <= kFarthest; }

Result<void> check_free_view(const View& view) {
  if (!good_place(view.viewpoint) || !good_place(view.lookpoint))
    return fail("viewpoint or lookpoint is no place within 10 km");
  if ((view.viewpoint - view.lookpoint).norm() < 1e-6)
    return fail("the viewpoint is the lookpoint", "set them apart from each other");
  if (!std::isfinite(view.twist)) return fail("the twist is no number");
  if (!(view.opening_angle > 0 && view.opening_angle < std::numbers::pi))
    return fail("the opening angle is not between 0 and pi");
  if (!(view.near_distance >= 0 && view.far_distance > view.near_distance && view.far_distance <= 1e6))
    return fail("the front clipping plane is not in front of the back one");
  return {};
}

bool same_view(const View& a, const View& b) {
  return a.viewpoint == b.viewpoint && a.lookpoint == b.lookpoint && a.twist == b.twist &&
         a.opening_angle == b.opening_angle && a.near_distance == b.near_distance && a.far_distance == b.far_distance &&
         a.orthogonal == b.orthogonal;
}

}  // namespace

Result<void> check_request(const PictureRequest& request) {
  if ((request.view ? 1 : 0) + (request.camera ? 1 : 0) + (request.free_view ? 1 : 0) > 1)
    return fail("a picture is of a view, of a camera or of a free view", "name one of them");
  if (request.view && (*request.view < 0 || *request.view >= static_cast<int>(kViews)))
    return fail(fmt::format("there is no view {}", *request.view), "views are 0 to 6");
  const auto good_edge = [](int edge) { return edge >= kSmallestImageEdge && edge <= kLargestImageEdge; };
  if (!good_edge(request.width) || !good_edge(request.height)) {
    return fail(fmt::format("a picture of {} x {} pixels", request.width, request.height),
                fmt::format("edges are {} to {} pixels", kSmallestImageEdge, kLargestImageEdge));
  }
  if (!(request.rate_hz >= kLowestPictureRate && request.rate_hz <= kHighestPictureRate)) {
    return fail(fmt::format("{} pictures a second", request.rate_hz),
                fmt::format("{} to {}", kLowestPictureRate, kHighestPictureRate));
  }
  if (request.quality < 1 || request.quality > 100)
    return fail(fmt::format("a quality of {}", request.quality), "1 to 100; 80 is good");
  return request.free_view ? check_free_view(*request.free_view) : Result<void>();
}

Result<void> check_camera(const PictureRequest& request, const CompiledCell& cell) {
  if (!request.camera) return {};
  std::vector<std::string> names;
  for (const CompiledCamera& camera : cell.cameras) {
    names.push_back(camera.name);
    if (camera.name == *request.camera || (*cell.paths)[static_cast<std::size_t>(camera.node)] == *request.camera)
      return {};
  }
  std::string remedy = did_you_mean(*request.camera, names);
  if (remedy.empty())
    remedy = names.empty() ? "the cell has no camera" : fmt::format("its cameras: {}", fmt::join(names, ", "));
  return fail(fmt::format("there is no camera {}", printable(*request.camera)), remedy);
}

bool same_drawing(const PictureRequest& a, const PictureRequest& b) {
  if (a.view != b.view || a.camera != b.camera || a.width != b.width || a.height != b.height) return false;
  if (a.free_view.has_value() != b.free_view.has_value()) return false;
  return !a.free_view || same_view(*a.free_view, *b.free_view);
}

}  // namespace cellmirror::app
