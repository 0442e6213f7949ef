#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "rt_core/geometry/proximity_mesh.hpp"
#include "rt_core/tissue/body/body_parts.hpp"

namespace cellmirror::tissue {
namespace {

template <class Values>
Eigen::Vector3d mixed(const EmbeddedPoint& point, const Values& values) {
  // From the first node on, so that the error is that of an element's size, not of its place.
  const Eigen::Vector3d& origin = values[point.node[0]];
  Eigen::Vector3d result = origin;
  for (std::size_t k = 1; k < 4; ++k) {
    if (point.weight[k] != 0) result += static_cast<double>(point.weight[k]) * (values[point.node[k]] - origin);
  }
  return result;
}

// Texture coordinates of the point of the mesh that is nearest to p.
Eigen::Vector2f texture_at(const geometry::MeshTree& tree, const SurfaceMesh& surface, const Eigen::Vector3d& p) {
  const geometry::Solid point = geometry::make_primitive(Shape::sphere, Eigen::Vector3d::Constant(1e-6));
  geometry::ProximityHint hint;
  Pose X_MP = Pose::Identity();
  X_MP.translation() = p;
  const geometry::Separation nearest =
      geometry::mesh_primitive_separation(tree, point.core, X_MP, std::numeric_limits<double>::infinity(), 0.0, hint);
  const auto& corners = surface.triangles[tree.original(hint.feature_a)];
  const Eigen::Vector3d& a = surface.vertices[corners[0]];
  const Eigen::Vector3d u = surface.vertices[corners[1]] - a;
  const Eigen::Vector3d v = surface.vertices[corners[2]] - a;
  const Eigen::Vector3d normal = u.cross(v);
  const double area = normal.squaredNorm();
  if (area <= 0) return surface.texture[corners[0]];
  const Eigen::Vector3d w = nearest.points.p_a - a;
  const auto s = static_cast<float>(w.cross(v).dot(normal) / area);
  const auto t = static_cast<float>(u.cross(w).dot(normal) / area);
  return (1.0F - s - t) * surface.texture[corners[0]] + s * surface.texture[corners[1]] +
         t * surface.texture[corners[2]];
}

std::array<float, 3> colour_at(const ObjectDescription& d, const Eigen::Vector3d& p) {
  std::array<float, 3> rgb{d.rgba[0], d.rgba[1], d.rgba[2]};
  for (const Region& region : d.regions) {
    if (!region.has_colour) continue;
    const Eigen::Vector3d along = region.b - region.a;
    const double length = along.squaredNorm();
    const double share = length > 0 ? std::clamp((p - region.a).dot(along) / length, 0.0, 1.0) : 0.0;
    const double distance = (p - region.a - share * along).norm() / region.radius_m;
    // Colours mix over the outer fifth of a region and a fifth beyond it.
    const auto weight = static_cast<float>(std::clamp((1.2 - distance) / 0.4, 0.0, 1.0));
    for (std::size_t k = 0; k < 3; ++k) rgb[k] += weight * (region.rgb[k] - rgb[k]);
  }
  return rgb;
}

}  // namespace

Eigen::Vector3d Body::position(const EmbeddedPoint& point) const { return mixed(point, parts_->now.x); }
Eigen::Vector3d Body::velocity(const EmbeddedPoint& point) const { return mixed(point, parts_->now.v); }

double Body::inverse_mass(const EmbeddedPoint& point) const {
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const double w = static_cast<double>(point.weight[k]);
    sum += w * w * parts_->now.inverse_mass[point.node[k]];
  }
  return sum;
}

void Body::add_impulse(const EmbeddedPoint& point, const Eigen::Vector3d& impulse) {
  for (std::size_t k = 0; k < 4; ++k) {
    parts_->now.v[point.node[k]] +=
        static_cast<double>(point.weight[k]) * parts_->now.inverse_mass[point.node[k]] * impulse;
  }
}

void Body::add_force(const EmbeddedPoint& point, const Eigen::Vector3d& force) {
  for (std::size_t k = 0; k < 4; ++k) {
    parts_->external_force[point.node[k]] += static_cast<double>(point.weight[k]) * force;
  }
}

EmbeddedPoint Body::embed_at_rest(const Eigen::Vector3d& p) const {
  const RestMesh& mesh = parts_->mesh;
  double best = -std::numeric_limits<double>::infinity();
  EmbeddedPoint result;
  for (const Element& element : parts_->start.topology.elements()) {
    const RestTetrahedron& t = mesh.tetrahedra[element.tetrahedron];
    Eigen::Matrix3d edges;
    const Eigen::Vector3d& origin = mesh.nodes[t.nodes[0]];
    for (int k = 0; k < 3; ++k) edges.col(k) = mesh.nodes[t.nodes[static_cast<std::size_t>(k) + 1]] - origin;
    const Eigen::Vector3d w = edges.inverse() * (p - origin);
    const Eigen::Vector4d weights(1.0 - w.sum(), w.x(), w.y(), w.z());
    const double least = weights.minCoeff();  // not negative: inside
    if (least <= best) continue;
    best = least;
    const Eigen::Vector4d clamped = weights.cwiseMax(0.0) / weights.cwiseMax(0.0).sum();
    result.node = element.nodes;
    result.tetrahedron = element.tetrahedron;
    for (std::size_t k = 0; k < 4; ++k) result.weight[k] = static_cast<float>(clamped[static_cast<int>(k)]);
    if (best >= 0) break;
  }
  follow_cuts(result);
  return result;
}

void Body::follow_cuts(EmbeddedPoint& point) const {
  const Topology& topology = parts_->now.topology;
  const RestTetrahedron& t = parts_->mesh.tetrahedra[point.tetrahedron];
  std::size_t corner = 4;  // the nearest one within the material
  for (std::size_t k = 0; k < 4; ++k) {
    if (parts_->mesh.inside[t.nodes[k]] != 0 && (corner == 4 || point.weight[k] > point.weight[corner])) corner = k;
  }
  for (std::size_t k = 0; k < kMostParts; ++k) {
    const std::uint32_t element = topology.part(point.tetrahedron, k);
    if (element == kNone) return;
    if (topology.elements()[element].owns(corner)) {
      point.node = topology.elements()[element].nodes;
      return;
    }
  }
}

std::uint64_t Body::revision() const { return parts_->revision; }
std::span<const EmbeddedPoint> Body::surface_points() const { return parts_->now.surface.points(); }
std::span<const std::array<std::uint32_t, 3>> Body::surface_triangles() const {
  return parts_->now.surface.triangles();
}
std::span<const std::uint8_t> Body::cut_faces() const { return parts_->now.surface.cut_faces(); }

std::span<const Eigen::Vector3d> Body::surface_positions() const {
  const Parts& p = *parts_;
  const std::span<const EmbeddedPoint> points = p.now.surface.points();
  if (!p.surface_current || p.surface_x.size() != points.size()) {
    p.surface_x.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) p.surface_x[i] = mixed(points[i], p.now.x);
    p.surface_current = true;
  }
  return p.surface_x;
}

double Body::burn(const EmbeddedPoint& point) const {
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k) sum += static_cast<double>(point.weight[k]) * parts_->now.burn[point.node[k]];
  return sum;
}

void Body::Parts::paint_surface() const {
  const std::span<const Eigen::Vector3d> rest = now.surface.rest_positions();
  constexpr double kNever = std::numeric_limits<double>::quiet_NaN();
  paint.painted_at.resize(rest.size(), Eigen::Vector3d::Constant(kNever));
  paint.rgb.resize(rest.size());
  if (texture_tree) paint.texture.resize(rest.size());
  for (std::size_t i = 0; i < rest.size(); ++i) {
    if (paint.painted_at[i] == rest[i]) continue;
    paint.painted_at[i] = rest[i];
    paint.rgb[i] = colour_at(description, rest[i]);
    if (texture_tree) paint.texture[i] = texture_at(*texture_tree, description.surface, rest[i]);
  }
}

void Body::fill(TissueSurface& surface) const {
  const Parts& p = *parts_;
  if (!p.published || p.published->revision != p.revision) {
    p.paint_surface();
    auto topology = std::make_shared<TissueTopology>();
    topology->revision = p.revision;
    const auto triangles = p.now.surface.triangles();
    topology->triangles.assign(triangles.begin(), triangles.end());
    const auto cut = p.now.surface.cut_faces();
    topology->cut_face.assign(cut.begin(), cut.end());
    topology->texture = p.paint.texture;
    topology->rgb = p.paint.rgb;
    p.published = std::move(topology);
  }
  surface.topology = p.published;
  const std::span<const Eigen::Vector3d> x = surface_positions();
  surface.vertices.resize(x.size());
  surface.normals.assign(x.size(), Eigen::Vector3f::Zero());
  surface.burn.resize(x.size());
  const std::span<const EmbeddedPoint> points = p.now.surface.points();
  for (std::size_t i = 0; i < x.size(); ++i) {
    surface.vertices[i] = x[i].cast<float>();
    surface.burn[i] = static_cast<float>(burn(points[i]));
  }
  for (const auto& [a, b, c] : p.published->triangles) {
    const Eigen::Vector3f normal = (x[b] - x[a]).cross(x[c] - x[a]).cast<float>();  // as long as the area counts
    surface.normals[a] += normal;
    surface.normals[b] += normal;
    surface.normals[c] += normal;
  }
  for (Eigen::Vector3f& normal : surface.normals) normal.stableNormalize();
}

}  // namespace cellmirror::tissue
