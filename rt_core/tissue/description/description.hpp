// What an .mpo file and a hyper file say, checked: plain data from which the simulation makes its bodies. SI. Points
// and directions are in the frame O of their object unless said.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/ports/mesh_appearance.hpp"
#include "rt_core/ports/tissue_settings.hpp"

namespace cellmirror::tissue {

// Neo-Hookean, slightly compressible (the energy of CalculiX's *HYPERELASTIC, NEO HOOKE).
struct Material {
  double youngs_modulus_pa = 5000;
  double poissons_ratio = 0.45;  // 0 to 0.49
  double density_kg_m3 = 1000;
  double damping_s = 1e-4;  // viscous stress = damping * stiffness * strain rate
  double drag_1_s = 1;      // damps all motion: force = drag * mass * velocity
  double yield_strain = 0;  // a stretch beyond it stays; 0: never
  double tear_strain = 0;   // a link stretched beyond it tears; 0: never
};

// Part of an object with a material of its own: all that lies in the sphere or in the capsule from a to b.
struct Region {
  std::string name;
  Eigen::Vector3d a = Eigen::Vector3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double radius_m = 0;
  Material material;
  std::array<float, 3> rgb{0.6F, 0.2F, 0.18F};
  bool has_colour = false;
};

// Nodes in this box or sphere never move.
struct FixedZone {
  Eigen::Vector3d low = Eigen::Vector3d::Zero();  // box; or the centre of the sphere
  Eigen::Vector3d high = Eigen::Vector3d::Zero();
  double radius_m = 0;  // of the sphere; 0: it is a box
};

enum class VesselKind : std::uint8_t { artery, vein, duct };

// Blood flows from the first point of the centre line to the last one; a duct carries no blood.
struct Vessel {
  std::string name;
  VesselKind kind = VesselKind::artery;
  double radius_m = 0.002;
  std::vector<Eigen::Vector3d> centre_line;  // at least 2 points, inside of the object
};

// A level surface of fluid: a rectangle about the origin of its object, z upwards.
struct PoolDescription {
  Eigen::Vector2d size_m = Eigen::Vector2d(0.1, 0.1);
  double level_m = 0;  // at the start, above the object's origin
  double max_level_m = 0.03;
  std::array<float, 4> rgba{0.75F, 0.80F, 0.82F, 0.45F};
};

// Tetrahedra of a file (.msh); none: a lattice is made that fills the surface.
struct TetraMesh {
  std::vector<Eigen::Vector3d> nodes;
  std::vector<std::array<std::uint32_t, 4>> tetrahedra;  // positive volume
};

struct SurfaceMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // closed, counter-clockwise from outside
  std::vector<Eigen::Vector2f> texture;                 // one a vertex, or none
  // A texture divides vertices at its seams: by vertex the first one at the same place. Empty: no two are there.
  std::vector<std::uint32_t> same_as;
};

struct ObjectDescription {
  std::string name;              // of the .mpo file without its folder: what SCRIPT names
  std::string file;              // for messages
  Pose X_WO = Pose::Identity();  // place in the world at the start
  SurfaceMesh surface;
  TetraMesh volume;               // empty: lattice
  double element_size_m = 0.007;  // edge of the cubes of the lattice
  int most_substeps = 4;          // of a step; where more were needed, mass is added
  Material material;
  std::vector<Region> regions;  // the last one that holds a point counts
  std::vector<FixedZone> fixed;
  std::vector<Vessel> vessels;
  std::vector<PoolDescription> pools;  // none or one
  std::uint16_t attributes = kDefaultTissueAttributes;
  std::array<float, 4> rgba{0.62F, 0.20F, 0.18F, 1.0F};
  std::shared_ptr<const MeshAppearance> look;  // picture of the surface's texture; may be null
};

// A ligament or an adhesion between two objects, or an object and the world (empty name).
struct Connection {
  std::string name;
  std::string object_a;
  std::string object_b;
  // Surface points of a within the radius of point_a (in the frame of a) are joined to the nearest ones of b.
  Eigen::Vector3d point_a = Eigen::Vector3d::Zero();
  Eigen::Vector3d point_b = Eigen::Vector3d::Zero();  // of b, or of the world
  double radius_m = 0;                                // 0: one pair, of the points nearest to point_a and point_b
  double stiffness_n_m = 50;                          // of all pairs together
  double tear_force_n = 0;                            // of all pairs together; 0: never
};

struct HyperDescription {
  std::string file;
  std::vector<Connection> connections;
};

}  // namespace cellmirror::tissue
