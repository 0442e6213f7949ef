// What a Body is made of. Private to this folder.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "rt_core/geometry/mesh_tree.hpp"
#include "rt_core/tissue/body/body.hpp"
#include "rt_core/tissue/body/elements.hpp"
#include "rt_core/tissue/body/embedded_surface.hpp"
#include "rt_core/tissue/body/rest_mesh.hpp"
#include "rt_core/tissue/body/topology.hpp"

namespace cellmirror::tissue {

// Everything that a step, a cut or heat changes: a copy of it is what reset() restores.
struct BodyState {
  explicit BodyState(const RestMesh& mesh) : topology(mesh) {}

  Topology topology;
  Elements elements;
  EmbeddedSurface surface;
  std::vector<Eigen::Vector3d> x;          // m, by node of the simulation, as all below
  std::vector<Eigen::Vector3d> v;          // m/s
  std::vector<double> inverse_mass;        // 1/kg, of the mass that is moved; 0: fixed
  std::vector<double> usual_inverse_mass;  // 1/kg, without the mass that a deformed element needs in a step
  std::vector<double> own_mass;            // kg, without what was added for a stable step: what has weight
  std::vector<double> burn;                // 0 raw, 1 coagulated, 2 charred
  std::vector<std::uint8_t> fixed;
};

// Texture and colour of surface points, kept until the point is another one.
struct SurfacePaint {
  std::vector<Eigen::Vector3d> painted_at;  // at rest; NaN: not yet
  std::vector<Eigen::Vector2f> texture;
  std::vector<std::array<float, 3>> rgb;
};

struct Body::Parts {
  Parts(ObjectDescription description_of_it, RestMesh rest_mesh)
      : description(std::move(description_of_it)), mesh(std::move(rest_mesh)), now(mesh), start(mesh) {}

  const ObjectDescription description;  // points and directions in the world
  const RestMesh mesh;
  BodyState now;
  BodyState start;
  std::uint16_t attributes = kDefaultTissueAttributes;
  std::vector<Eigen::Vector3d> force;           // N, by node, of the last begin_step()
  std::vector<Eigen::Vector3d> external_force;  // N, for the next one
  KernelSums sums;
  std::uint64_t revision = 1;
  std::uint64_t counted_revision = 0;  // for which part_count was counted
  std::uint32_t part_count = 1;
  std::size_t next_edge = 0;  // where the search for tears goes on

  mutable std::vector<Eigen::Vector3d> surface_x;
  mutable bool surface_current = false;
  mutable SurfacePaint paint;
  mutable std::shared_ptr<const TissueTopology> published;
  std::unique_ptr<geometry::MeshTree> texture_tree;  // of the surface that has texture coordinates

  std::vector<Elements::Extra> extras;      // of this step
  std::vector<std::uint32_t> heavy;         // nodes whose mass is larger in this step
  std::vector<double> extra_mass;           // kg, by node: of those above, 0 of others
  std::vector<std::uint32_t> heavy_before;  // in the step before, while a step takes their place
  std::vector<double> extra_mass_before;

  void set_masses(std::span<const std::uint32_t> nodes);
  void add_extra_masses();
  void adopt(const TopologyChange& change);
  [[nodiscard]] bool is_loose(std::uint32_t element) const;
  [[nodiscard]] CutResult divide(std::span<const Topology::Division> divisions, const Eigen::Vector3d& at);
  void paint_surface() const;
  [[nodiscard]] std::uint32_t count_parts() const;
  [[nodiscard]] std::uint32_t first_node_of(std::uint32_t rest_node) const;  // in `start`
  [[nodiscard]] Pose orientation_at(std::uint32_t node) const;
};

}  // namespace cellmirror::tissue
