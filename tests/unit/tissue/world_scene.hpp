// Blocks of soft tissue and instruments for tests of the world.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "rt_core/tissue/world.hpp"

namespace cellmirror::tissue {

// A box from `low` to `high`, in O.
inline SurfaceMesh box_surface(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  SurfaceMesh mesh;
  for (unsigned i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back((i & 1U) != 0 ? high.x() : low.x(), (i & 2U) != 0 ? high.y() : low.y(),
                               (i & 4U) != 0 ? high.z() : low.z());
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

// Its upper face is at z = 0 of its frame, about the origin; its lower nodes are fixed if `fixed`.
inline ObjectDescription block(const std::string& name, const Eigen::Vector3d& size, bool fixed = true) {
  ObjectDescription d;
  d.name = name;
  d.file = name + ".mpo";
  d.surface = box_surface({-size.x() / 2, -size.y() / 2, -size.z()}, {size.x() / 2, size.y() / 2, 0});
  d.element_size_m = 0.008;
  if (fixed) {
    d.fixed.push_back({.low = {-1, -1, -size.z() - 0.01}, .high = {1, 1, -size.z() + 0.006}});
  }
  d.attributes = kAllTissueAttributes &
                 ~(static_cast<unsigned>(TissueAttribute::gravity) | static_cast<unsigned>(TissueAttribute::tear) |
                   static_cast<unsigned>(TissueAttribute::plastic));
  return d;
}

// An instrument that points downwards (its z axis is -z of the world), with its tool centre point at p.
inline Pose downwards(const Eigen::Vector3d& p) {
  Pose X = Pose::Identity();
  X.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  X.translation() = p;
  return X;
}

// Along +x of the world, jaws open along z.
inline Pose along_x(const Eigen::Vector3d& p) {
  Pose X = Pose::Identity();
  X.linear().col(0) = -Eigen::Vector3d::UnitY();
  X.linear().col(1) = Eigen::Vector3d::UnitZ();
  X.linear().col(2) = Eigen::Vector3d::UnitX();
  X.linear().col(0) = X.linear().col(1).cross(X.linear().col(2));
  X.translation() = p;
  return X;
}

class Scene {
 public:
  explicit Scene(std::vector<ObjectDescription> objects, std::vector<Connection> connections = {}) {
    Result<World> made = World::make(std::move(objects), std::move(connections));
    EXPECT_TRUE(made.has_value()) << (made ? "" : made.error().text());
    if (made) world_ = std::make_unique<World>(*std::move(made));
  }

  World& world() { return *world_; }
  void instrument(int slot, const Pose& X_WT, double q = 0) {
    for (Tool& tool : tools_) {
      if (tool.slot == slot) {
        tool.X = X_WT;
        tool.q[0] = q;
        return;
      }
    }
    tools_.push_back({slot, X_WT, {q}});
  }
  void remove_instrument(int slot) {
    std::erase_if(tools_, [&](const Tool& tool) { return tool.slot == slot; });
  }
  void set_bodies(std::vector<RigidBodyPose> bodies) { bodies_ = std::move(bodies); }

  void step() {
    std::vector<InstrumentPose> poses;
    for (const Tool& tool : tools_) poses.push_back({tool.slot, tool.X, tool.q});
    time_ns_ += 1'000'000;
    world_->step({Timestamp{time_ns_}, poses, bodies_});
    for (const TissueEvent& event : world_->events()) events_.push_back(event);
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) step();
  }
  // Moves an instrument on a straight line at a constant speed.
  void move(int slot, const Eigen::Vector3d& to, double speed_m_s) {
    for (;;) {
      Tool* tool = nullptr;
      for (Tool& one : tools_) tool = one.slot == slot ? &one : tool;
      ASSERT_NE(tool, nullptr);
      const Eigen::Vector3d way = to - tool->X.translation();
      const double most = speed_m_s * kStep_s;
      if (way.norm() < 1e-12) return;
      tool->X.translation() += way.norm() > most ? Eigen::Vector3d(most / way.norm() * way) : way;
      step();
    }
  }

  [[nodiscard]] TissueState state() const {
    TissueState state;
    world_->describe(state);
    return state;
  }
  [[nodiscard]] TissueView view() const {
    TissueView view;
    world_->view(view, false);
    return view;
  }
  [[nodiscard]] InstrumentResponse response(int slot) const {
    for (const InstrumentResponse& one : world_->responses()) {
      if (one.slot == slot) return one;
    }
    return {};
  }
  [[nodiscard]] const std::vector<TissueEvent>& events() const { return events_; }
  [[nodiscard]] int count(TissueEventKind kind) const {
    int n = 0;
    for (const TissueEvent& event : events_) n += event.kind == kind ? 1 : 0;
    return n;
  }

 private:
  struct Tool {
    int slot;
    Pose X;
    std::array<double, 1> q;
  };

  std::unique_ptr<World> world_;
  std::vector<Tool> tools_;
  std::vector<RigidBodyPose> bodies_;
  std::vector<TissueEvent> events_;
  std::int64_t time_ns_ = 1'000'000'000;
};

inline bool finite(const TissueView& view) {
  for (const TissueSurface& surface : view.surfaces) {
    for (const Eigen::Vector3f& p : surface.vertices) {
      if (!p.allFinite() || p.norm() > 10) return false;
    }
  }
  return true;
}

// Closes its jaws, and acts, where joint 0 is below 0.5.
inline SetInstrumentAction acts_below(int slot, InstrumentKind kind) {
  return {slot, {.kind = kind, .test = InstrumentTest::below, .joint = 0, .value_1 = 0.5}};
}

}  // namespace cellmirror::tissue
