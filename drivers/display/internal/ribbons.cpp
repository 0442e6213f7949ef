#include "drivers/display/internal/ribbons.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror::display {

namespace {

constexpr float kSoftEdge = 1.0F;    // pixels beside the line
constexpr float kDashPeriod = 9.0F;  // pixels
constexpr double kBeside = 1.25;     // how far beside the picture a line is still followed

std::array<std::uint8_t, 4> bytes_of(const Colour& colour) {
  std::array<std::uint8_t, 4> bytes{};
  for (std::size_t i = 0; i < 4; ++i) {
    const float value = std::isfinite(colour[i]) ? std::clamp(colour[i], 0.0F, 1.0F) : 0.0F;
    bytes[i] = static_cast<std::uint8_t>(std::lround(value * 255.0F));
  }
  return bytes;
}

// The part of the segment a to b (clip space) that is before the eye and not far beside the picture, as parameters
// along it; Liang and Barsky.
struct Part {
  double begin = 0;
  double end = 1;
};

bool clip_part(const Eigen::Vector4d& a, const Eigen::Vector4d& b, Part& part) {
  const auto cut = [&](double at_a, double at_b) {  // inside: positive
    if (at_a < 0 && at_b < 0) return false;
    if (at_a < 0) part.begin = std::max(part.begin, at_a / (at_a - at_b));
    if (at_b < 0) part.end = std::min(part.end, at_a / (at_a - at_b));
    return part.begin < part.end;
  };
  return cut(a.w() + a.z(), b.w() + b.z()) && cut(kBeside * a.w() - a.x(), kBeside * b.w() - b.x()) &&
         cut(kBeside * a.w() + a.x(), kBeside * b.w() + b.x()) &&
         cut(kBeside * a.w() - a.y(), kBeside * b.w() - b.y()) && cut(kBeside * a.w() + a.y(), kBeside * b.w() + b.y());
}

Colour between(const Colour& a, const Colour& b, double part) {
  Colour colour{};
  for (std::size_t i = 0; i < 4; ++i) colour[i] = a[i] + static_cast<float>(part) * (b[i] - a[i]);
  return colour;
}

}  // namespace

void Ribbons::clear() {
  vertices_.clear();
  indices_.clear();
}

void Ribbons::piece(const std::array<RibbonVertex, 4>& corners) {
  const auto first = static_cast<std::uint32_t>(vertices_.size());
  vertices_.insert(vertices_.end(), corners.begin(), corners.end());
  for (const std::uint32_t corner : {0U, 1U, 2U, 2U, 1U, 3U}) indices_.push_back(first + corner);
}

void Ribbons::line(const ViewTransform& view, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                   const Style& style) {
  if (vertices_.size() >= 4 * kMostPieces || !from.allFinite() || !to.allFinite()) return;
  const Eigen::Vector4d a = view.clip(from);
  const Eigen::Vector4d b = view.clip(to);
  Part part;
  if (!a.allFinite() || !b.allFinite() || !clip_part(a, b, part)) return;
  const std::array<double, 2> ends = {part.begin, part.end};
  std::array<Eigen::Vector3d, 2> ndc;
  for (std::size_t i = 0; i < 2; ++i) {
    const Eigen::Vector4d p = a + ends[i] * (b - a);
    if (!(p.w() > 0)) return;
    ndc[i] = p.head<3>() / p.w();
  }
  const Eigen::Vector2d half_size(view.pixels().width / 2.0, view.pixels().height / 2.0);
  const Eigen::Vector2d pixels = (ndc[1] - ndc[0]).head<2>().cwiseProduct(half_size);
  const double length = pixels.norm();
  if (!(length > 1e-3)) return;
  const float width = std::isfinite(style.width_px) ? std::clamp(style.width_px, 0.5F, 64.0F) : 1.5F;
  const float reach = width / 2 + kSoftEdge;
  const Eigen::Vector2d side =
      (Eigen::Vector2d(-pixels.y(), pixels.x()) / length * static_cast<double>(reach)).cwiseQuotient(half_size);
  std::array<RibbonVertex, 4> corners;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t end = i / 2;
    const float sign = i % 2 == 0 ? -1.0F : 1.0F;
    const Eigen::Vector2d at = ndc[end].head<2>() + static_cast<double>(sign) * side;
    corners[i].place = {static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(ndc[end].z())};
    corners[i].rgba = bytes_of(between(style.rgba_from, style.rgba_to, ends[end]));
    corners[i].shape = {sign * reach, width / 2, end == 0 ? 0.0F : static_cast<float>(length),
                        style.dashed ? kDashPeriod : 0.0F};
  }
  piece(corners);
}

void Ribbons::glow(const ViewTransform& view, const Eigen::Vector3d& centre, double radius_px, const Colour& rgba) {
  if (vertices_.size() >= 4 * kMostPieces || !centre.allFinite() || !(radius_px > 0) || radius_px > 4096) return;
  const Eigen::Vector4d clip = view.clip(centre);
  if (!clip.allFinite() || !(clip.w() > 0) || clip.z() < -clip.w()) return;
  const Eigen::Vector3d ndc = clip.head<3>() / clip.w();
  if (ndc.head<2>().cwiseAbs().maxCoeff() > 4) return;
  std::array<RibbonVertex, 4> corners;
  for (std::size_t i = 0; i < 4; ++i) {
    const float u = i % 2 == 0 ? -1.0F : 1.0F;
    const float v = i / 2 == 0 ? -1.0F : 1.0F;
    corners[i].place = {static_cast<float>(ndc.x() + static_cast<double>(u) * 2 * radius_px / view.pixels().width),
                        static_cast<float>(ndc.y() + static_cast<double>(v) * 2 * radius_px / view.pixels().height),
                        static_cast<float>(ndc.z())};
    corners[i].rgba = bytes_of(rgba);
    corners[i].shape = {u, -1.0F, v, 0.0F};
  }
  piece(corners);
}

}  // namespace cellmirror::display
