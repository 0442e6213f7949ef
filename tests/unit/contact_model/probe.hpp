// A ball on three linear axes, and whatever is around it: constraints in its space are those of plain geometry.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rt_core/contact_model/contact_finder.hpp"
#include "tests/unit/cell/cell_from_text.hpp"
#include "tests/unit/geometry_mesh/shapes.hpp"

namespace cellmirror::contact_model {

inline constexpr double kBall = 0.002;   // m, radius of the probe
inline constexpr double kMargin = 2e-5;  // m, FinderSettings::margin_m
inline constexpr double kReach = 0.01;   // m, FinderSettings::reach_m

// `geometry`: of the instrument, beside the ball at its tip.
inline std::string probe_text(const std::string& geometry) {
  const auto axis = [](const std::string& name, const std::string& parent, const std::string& direction) {
    return "[[node]]\nname = \"" + name + "\"\n" + (parent.empty() ? "" : "parent = \"" + parent + "\"\n") +
           "joint = { type = \"prismatic\", axis = " + direction +
           ", range_m = [-10.0, 10.0], velocity_m_s = 1.0, acceleration_m_s2 = 1.0 }\n";
  };
  return axis("X", "", "[1, 0, 0]") + axis("Y", "X", "[0, 1, 0]") + axis("Z", "Y", "[0, 0, 1]") +
         "[[node]]\nname = \"TIP\"\nparent = \"Z\"\ngeometry = [" + geometry +
         "]\n[robot]\nid = \"PROBE\"\nflange = \"TIP\"\n";
}

struct Probe : testing::Test {
  void build(const std::string& surroundings, const std::string& instrument = "{ sphere_m = 0.002 }",
             const std::map<std::string, std::string>& predecessors = {}) {
    files->add("probe.mpc", probe_text(instrument));
    files->add("second.mpc", probe_text("{ sphere_m = 0.002 }"));
    Diagnostics diagnostics;
    cell = build_cell(surroundings + "\n[[node]]\nname = \"Probe\"\nabstract = \"probe.mpc\"\n", files, diagnostics,
                      predecessors);
    ASSERT_TRUE(cell) << diagnostics.text();
    q = cell->start_positions();
    slot = cell->robot("PROBE")->slot();
    sut = std::make_unique<ContactFinder>(slot, FinderSettings{});
    adopt();
  }
  void adopt() {
    compiled = cell->compile();
    pairs = derivation.derive(*compiled, {});
    sut->adopt(compiled, pairs);
  }
  // Puts a mesh in the place of all geometry of a body.
  void replace(const std::string& name, const geometry::Soup& soup) {
    geometry::MeshFindings findings;
    auto mesh = geometry::make_mesh(name, soup.vertices, soup.triangles, findings);
    ASSERT_TRUE(mesh);
    auto changed = std::make_shared<collision::PairTable>(*pairs);
    for (std::size_t i = 0; i < changed->bodies.size(); ++i) {
      if ((*changed->names)[i] != name) continue;
      const auto shared = std::make_shared<const geometry::TriangleMesh>(std::move(*mesh));
      changed->bodies[i].parts = {{std::make_shared<geometry::Solid>(geometry::make_mesh_solid(shared)),
                                   changed->bodies[i].parts.front().X_NG}};
    }
    pairs = changed;
    sut->adopt(compiled, pairs);
  }

  const haptics::ContactModel& at(const Eigen::Vector3d& x) {
    for (std::size_t i = 0; i < 3; ++i) q[slot][i] = x[static_cast<Eigen::Index>(i)];
    return again();
  }
  const haptics::ContactModel& again() {
    compute_poses(*compiled, q, poses);
    sut->find(poses, Timestamp{++now}, model);
    return model;
  }
  // m: how far the tip may go from x_ref in a direction.
  double free_way(const Eigen::Vector3d& direction) const {
    double way = 1e9;
    for (std::size_t i = 0; i < model.count; ++i) {
      const double closing = -model.constraints[i].a.dot(direction);
      if (closing > 1e-12) way = std::min(way, model.constraints[i].gap / closing);
    }
    return way;
  }

  std::shared_ptr<TextFiles> files = std::make_shared<TextFiles>();
  std::optional<Cell> cell;
  collision::PairDerivation derivation{std::make_shared<geometry::SolidLibrary>()};
  std::shared_ptr<const CompiledCell> compiled;
  std::shared_ptr<const collision::PairTable> pairs;
  std::vector<JointValues> q;
  CellPoses poses;
  std::size_t slot = 0;
  std::int64_t now = 0;
  haptics::ContactModel model;
  std::unique_ptr<ContactFinder> sut;
};

}  // namespace cellmirror::contact_model
