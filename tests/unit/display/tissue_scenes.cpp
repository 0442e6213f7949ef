#include "tests/unit/display/tissue_scenes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "tests/unit/display/test_scenes.hpp"

namespace cellmirror::display {

namespace {

std::vector<Eigen::Vector3f> vertex_normals(const TissueSurface& surface) {
  std::vector<Eigen::Vector3f> normals(surface.vertices.size(), Eigen::Vector3f::Zero());
  for (const auto& t : surface.topology->triangles) {
    const Eigen::Vector3f& a = surface.vertices[t[0]];
    const Eigen::Vector3f area = (surface.vertices[t[1]] - a).cross(surface.vertices[t[2]] - a);
    for (const std::uint32_t vertex : t) normals[vertex] += area;
  }
  for (Eigen::Vector3f& normal : normals) normal.normalize();
  return normals;
}

std::shared_ptr<TissueTopology> copy_of(const TissueTopology& topology) {
  auto copy = std::make_shared<TissueTopology>(topology);
  ++copy->revision;
  return copy;
}

// What lies in the cone about `direction` is burnt, most in its middle.
void burn(TissueSurface& surface, const Eigen::Vector3f& direction) {
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    const float beside = 1 - surface.vertices[i].normalized().dot(direction.normalized());
    surface.burn[i] = std::clamp(2.2F - 70.0F * beside, 0.0F, 2.0F);
  }
}

// Triangles near the plane x = 0 above are faces of a cut.
void cut(TissueSurface& surface) {
  auto topology = copy_of(*surface.topology);
  for (std::size_t i = 0; i < topology->triangles.size(); ++i) {
    Eigen::Vector3f middle = Eigen::Vector3f::Zero();
    for (const std::uint32_t vertex : topology->triangles[i]) middle += surface.vertices[vertex] / 3;
    topology->cut_face[i] = std::abs(middle.x() - 0.02F) < 0.006F && middle.z() > 0.01F ? 1 : 0;
  }
  surface.topology = topology;
}

TissueClip clip_at(const Eigen::Vector3d& at) {
  TissueClip clip;
  clip.X_WC.translation() = at;
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const float side : {-1.0F, 1.0F}) {  // two bars
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (std::uint32_t i = 0; i < 8; ++i) {
      vertices.emplace_back((i & 1U) != 0 ? 0.006F : -0.006F, side * 0.0016F + ((i & 2U) != 0 ? 0.0006F : -0.0006F),
                            (i & 4U) != 0 ? 0.0012F : 0.0F);
    }
    for (const auto& t : std::vector<std::array<std::uint32_t, 3>>{{0, 2, 1},
                                                                   {1, 2, 3},
                                                                   {4, 5, 6},
                                                                   {5, 7, 6},
                                                                   {0, 1, 4},
                                                                   {1, 5, 4},
                                                                   {2, 6, 3},
                                                                   {3, 6, 7},
                                                                   {0, 4, 2},
                                                                   {2, 4, 6},
                                                                   {1, 3, 5},
                                                                   {3, 7, 5}})
      triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  clip.vertices = std::make_shared<const std::vector<Eigen::Vector3f>>(std::move(vertices));
  clip.triangles = std::make_shared<const std::vector<std::array<std::uint32_t, 3>>>(std::move(triangles));
  return clip;
}

TissuePool rippled_pool() {
  TissuePool pool;
  pool.present = true;
  pool.X_WP.translation() << 0, 0, -0.03;
  pool.size_m = {0.2F, 0.16F};
  pool.level_m = 0.004;
  pool.rgba = {0.62F, 0.42F, 0.43F, 0.62F};
  pool.columns = 48;
  for (int row = 0; row < 40; ++row) {
    for (int column = 0; column < 48; ++column) {
      const double far = std::hypot(column - 40.0, row - 8.0);
      pool.heights_m.push_back(static_cast<float>(0.0008 * std::sin(far) / (1 + 0.1 * far)));
    }
  }
  return pool;
}

void add_particles(TissueView& view) {
  for (int i = 0; i < 40; ++i) {
    const float t = static_cast<float>(i) / 40;
    const float turn = 2.4F * static_cast<float>(i);
    view.particles.push_back(
        {{0.03F + 0.02F * t, -0.03F - 0.01F * t * std::cos(turn), 0.02F + 0.02F * t - 0.05F * t * t}, 0.0008F, 0, t});
    view.particles.push_back(
        {{-0.03F + 0.01F * t * std::sin(turn), -0.03F, 0.045F + 0.04F * t}, 0.004F + 0.006F * t, 1, t});
    if (i % 4 == 0) view.particles.push_back({{-0.05F + 0.03F * t, -0.05F, 0.03F * (1 - t)}, 0.001F, 2, t});
  }
}

}  // namespace

std::shared_ptr<const TissueTopology> organ_topology(unsigned around, unsigned across) {
  auto topology = std::make_shared<TissueTopology>();
  const auto at = [&](unsigned ring, unsigned i) { return ring * around + i % around; };
  for (unsigned ring = 0; ring < across; ++ring) {
    for (unsigned i = 0; i < around; ++i) {
      topology->triangles.push_back({at(ring, i), at(ring, i + 1), at(ring + 1, i + 1)});
      topology->triangles.push_back({at(ring, i), at(ring + 1, i + 1), at(ring + 1, i)});
    }
  }
  for (unsigned i = 1; i + 1 < around; ++i) {  // closed at its poles
    topology->triangles.push_back({at(0, 0), at(0, i + 1), at(0, i)});
    topology->triangles.push_back({at(across, 0), at(across, i), at(across, i + 1)});
  }
  topology->cut_face.assign(topology->triangles.size(), 0);
  topology->rgb.assign(std::size_t{around} * (across + 1), {0.62F, 0.20F, 0.18F});
  return topology;
}

TissueSurface organ(std::shared_ptr<const TissueTopology> topology, unsigned around, unsigned across, double radius_m,
                    double phase) {
  TissueSurface surface;
  surface.name = "organ";
  surface.topology = std::move(topology);
  for (unsigned ring = 0; ring <= across; ++ring) {
    const double down = -std::numbers::pi / 2 + 1e-3 + (std::numbers::pi - 2e-3) * ring / across;
    for (unsigned i = 0; i < around; ++i) {
      const double turn = 2 * std::numbers::pi * i / around;
      const double radius =
          radius_m * (1 + 0.06 * std::sin(3 * turn + phase) * std::cos(down) + 0.05 * std::sin(4 * down));
      const Eigen::Vector3d p = radius * Eigen::Vector3d(1.3 * std::cos(down) * std::cos(turn),
                                                         0.9 * std::cos(down) * std::sin(turn), 0.7 * std::sin(down));
      surface.vertices.push_back(p.cast<float>());
    }
  }
  surface.normals = vertex_normals(surface);
  surface.burn.assign(surface.vertices.size(), 0);
  return surface;
}

TissueSurface tissue_sheet(unsigned cells) {
  TissueSurface surface;
  surface.name = "sheet";
  surface.wet = false;
  auto topology = std::make_shared<TissueTopology>();
  for (unsigned row = 0; row <= cells; ++row) {
    for (unsigned column = 0; column <= cells; ++column) {
      const auto along = [&](unsigned i) { return 2 * static_cast<float>(i) / static_cast<float>(cells) - 1; };
      surface.vertices.emplace_back(along(column), 0.0F, along(row));
      topology->texture.emplace_back((along(column) + 1) / 2, (1 - along(row)) / 2);
      if (row == cells || column == cells) continue;
      const unsigned first = row * (cells + 1) + column;
      topology->triangles.push_back({first, first + 1, first + cells + 2});
      topology->triangles.push_back({first, first + cells + 2, first + cells + 1});
    }
  }
  topology->cut_face.assign(topology->triangles.size(), 0);
  topology->rgb.assign(surface.vertices.size(), {0.6F, 0.6F, 0.6F});
  surface.topology = topology;
  surface.normals.assign(surface.vertices.size(), -Eigen::Vector3f::UnitY());
  surface.burn.assign(surface.vertices.size(), 0);
  return surface;
}

TissueNetwork organ_network(double radius_m, double edge_m) {
  TissueNetwork network;
  constexpr int kReach = 10;
  const Eigen::Vector3d axes = radius_m * Eigen::Vector3d(1.3, 0.9, 0.7);
  std::map<std::array<int, 3>, std::uint32_t> numbers;
  for (int x = -kReach; x <= kReach; ++x) {
    for (int y = -kReach; y <= kReach; ++y) {
      for (int z = -kReach; z <= kReach; ++z) {
        const Eigen::Vector3d p = edge_m * Eigen::Vector3d(x, y, z);
        const double out = p.cwiseQuotient(axes).norm();
        if (out > 1) continue;
        const auto number = static_cast<std::uint32_t>(network.nodes.size());
        numbers[{x, y, z}] = number;
        network.nodes.push_back(p.cast<float>());
        const bool touched = out > 0.75 && x > 0 && y < 0 && z > 0;
        network.kinds.push_back(p.z() < -0.75 * axes.z() ? TissueNodeKind::fixed
                                : touched                ? TissueNodeKind::contact
                                : out > 0.75             ? TissueNodeKind::outer
                                                         : TissueNodeKind::inner);
        for (const std::array<int, 3>& before : {std::array{x - 1, y, z}, {x, y - 1, z}, {x, y, z - 1}}) {
          if (const auto other = numbers.find(before); other != numbers.end())
            network.links.push_back({other->second, number});
        }
      }
    }
  }
  return network;
}

Scene with_tissue(TissueView view) {
  Scene scene;
  scene.tissue = std::make_shared<const TissueView>(std::move(view));
  return scene;
}

Scene tissue_gallery_scene() {
  TissueView view;
  TissueSurface& surface = view.surfaces.emplace_back(organ(organ_topology(120, 60), 120, 60, 0.05, 0.4));
  burn(surface, {-0.5F, -0.55F, 0.9F});
  cut(surface);
  view.clips.push_back(clip_at({0.045, -0.012, 0.028}));
  view.pool = rippled_pool();
  add_particles(view);
  view.lens_fog = 0.35;
  view.smoke = 0.2;
  view.step = 1;
  Scene scene = with_tissue(std::move(view));
  add_box(scene, {0.24, 0.2, 0.01}, at(0, 0, -0.045)).rgba = {0.55F, 0.62F, 0.60F, 1};
  scene.floor_z_m = -0.05;
  scene.floor_low = {-0.2, -0.2};
  scene.floor_high = {0.2, 0.2};
  for (const DisplayMode mode :
       {DisplayMode::floor, DisplayMode::shadows, DisplayMode::antialiasing, DisplayMode::textures})
    scene.modes.set(static_cast<std::size_t>(mode));
  return scene;
}

Pane tissue_gallery_pane() { return pane_looking_at({0.06, -0.24, 0.16}, {0, 0, 0}, 0.7); }

}  // namespace cellmirror::display
