#include "tests/bench/ranging/bench_cell.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>

namespace cellmirror {

namespace {

using Eigen::Vector3d;
using Mesh = std::shared_ptr<geometry::TriangleMesh>;

// A surface over a grid of [0, 1] x [0, 1].
template <typename Surface>
void add_surface(geometry::TriangleMesh& mesh, std::uint32_t columns, std::uint32_t rows, const Surface& surface) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::uint32_t i = 0; i <= columns; ++i) {
    for (std::uint32_t k = 0; k <= rows; ++k) {
      mesh.vertices.push_back(surface(static_cast<double>(i) / columns, static_cast<double>(k) / rows));
    }
  }
  for (std::uint32_t i = 0; i < columns; ++i) {
    for (std::uint32_t k = 0; k < rows; ++k) {
      const std::uint32_t a = first + i * (rows + 1) + k;
      const std::uint32_t b = a + rows + 1;
      mesh.triangles.push_back({a, b, b + 1});
      mesh.triangles.push_back({a, b + 1, a + 1});
    }
  }
}

// Along z from 0 to `length`; bumps as of a casting.
Mesh tube(double radius, double length, double bumps, std::uint32_t columns, std::uint32_t rows) {
  auto mesh = std::make_shared<geometry::TriangleMesh>();
  add_surface(*mesh, columns, rows, [&](double u, double v) {
    const double angle = 2.0 * std::numbers::pi * u;
    const double closing = std::sqrt(std::max(1e-4, 1.0 - std::pow(2.0 * v - 1.0, 8.0)));
    const double r = radius * closing * (1.0 + bumps * std::sin(3.0 * angle + 9.0 * v) * std::sin(11.0 * v));
    return Vector3d(r * std::cos(angle), r * std::sin(angle), length * v);
  });
  return mesh;
}

Mesh floor_of(double half, std::uint32_t cells) {
  auto mesh = std::make_shared<geometry::TriangleMesh>();
  add_surface(*mesh, cells, cells,
              [&](double u, double v) { return Vector3d(half * (2.0 * u - 1.0), half * (2.0 * v - 1.0), 0.0); });
  return mesh;
}

Mesh block(const Vector3d& half, std::uint32_t cells) {
  auto mesh = std::make_shared<geometry::TriangleMesh>();
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      add_surface(*mesh, cells, cells, [&](double u, double v) {
        Vector3d p;
        p[axis] = side * half[axis];
        p[(axis + 1) % 3] = half[(axis + 1) % 3] * (2.0 * u - 1.0);
        p[(axis + 2) % 3] = half[(axis + 2) % 3] * (2.0 * v - 1.0);
        return p;
      });
    }
  }
  return mesh;
}

class Builder {
 public:
  Builder() {
    cell_->revision = 1;
    cell_->robot_of_slot.fill(-1);
    add_node(-1, Pose::Identity(), "WORLD");
  }

  void add_environment() {
    add_fixed(floor_of(4.0, 60), Vector3d::Zero(), Vector3d::Zero());
    for (int i = 0; i < 8; ++i) {
      const double angle = std::numbers::pi / 4.0 * i;
      add_fixed(block({0.4, 0.3, 0.4}, 12), {2.6 * std::cos(angle), 2.6 * std::sin(angle), 0.4}, {0, 0, angle});
    }
    for (int i = 0; i < 10; ++i) {
      const double angle = 0.3 + 0.62 * i;
      add_fixed(tube(0.05, 3.0, 0.1, 20, 28), {3.2 * std::cos(angle), 3.2 * std::sin(angle), 0.0},
                {0.2 * std::sin(3.0 * i), 0.2 * std::cos(5.0 * i), 0.0});
    }
  }
  void fix() {
    cell_->fixed_count = cell_->parent.size();
    for (std::size_t i = 0; i < cell_->fixed_count; ++i) cell_->X_WN_fixed.push_back(cell_->X_PF[i]);
  }
  void add_arms() {
    const Mesh link = tube(0.11, 0.42, 0.25, 40, 30);
    for (std::size_t arm = 0; arm < kBenchArms; ++arm) {
      const double angle = 0.5 * std::numbers::pi * static_cast<double>(arm);
      std::int32_t parent = 0;
      for (std::size_t joint = 0; joint < kBenchLinks; ++joint) {
        const Vector3d at =
            joint == 0 ? Vector3d(1.1 * std::cos(angle), 1.1 * std::sin(angle), 0.05) : Vector3d(0.0, 0.0, 0.40);
        parent = add_joint(parent, at, arm, joint);
        add_geometry(parent, link);
        links_.push_back(parent);
      }
    }
  }
  void add_sensors() {
    for (std::size_t i = 0; i < kBenchSensors; ++i) {
      const double turn = 2.4 * static_cast<double>(i);
      CompiledSensor sensor;
      sensor.name = "USS_" + std::to_string(i);
      const bool rides = i % 4 == 3;
      const double out = 2.0 + 0.8 * std::sin(5.0 * turn);
      // On a link a hand's breadth out of the skin, or standing around and looking inwards.
      const Pose X = rides ? pose_from_xyz_rpy({0.16 * std::cos(turn), 0.16 * std::sin(turn), 0.2},
                                               {0.0, 0.5 * std::numbers::pi, turn})
                           : pose_from_xyz_rpy({out * std::cos(turn), out * std::sin(turn), 0.9 + 0.6 * std::cos(turn)},
                                               {0.0, -0.5 * std::numbers::pi + 0.3 * std::sin(7.0 * turn), turn});
      const std::int32_t parent = rides ? links_[(i / 4) % links_.size()] : 0;
      sensor.node = add_node(parent, X, sensor.name);
      sensor.sensor.half_angle_rad = (i % 3 == 0 ? 7.5 : i % 3 == 1 ? 15.0 : 30.0) * std::numbers::pi / 180.0;
      sensor.sensor.active = true;
      cell_->sensors.push_back(sensor);
    }
  }
  std::shared_ptr<const CompiledCell> done() {
    cell_->paths = std::make_shared<const std::vector<std::string>>(names_);
    return cell_;
  }

 private:
  std::int32_t add_node(std::int32_t parent, const Pose& X_PF, std::string name) {
    cell_->parent.push_back(parent);
    cell_->naming_parent.push_back(parent);
    cell_->X_PF.push_back(X_PF);
    cell_->joint_of.push_back(-1);
    cell_->visible.push_back(1);
    names_.push_back(std::move(name));
    return static_cast<std::int32_t>(cell_->parent.size() - 1);
  }
  std::int32_t add_joint(std::int32_t parent, const Vector3d& at, std::size_t arm, std::size_t number) {
    const std::int32_t node = add_node(parent, pose_from_xyz_rpy(at, Vector3d::Zero()),
                                       "ARM_" + std::to_string(arm) + "." + std::to_string(number));
    CompiledJoint joint;
    joint.axis = number % 2 == 0 ? Vector3d::UnitZ() : Vector3d::UnitY();
    joint.kind = JointKind::revolute;
    joint.slot = static_cast<std::uint8_t>(arm);
    joint.joint = static_cast<std::uint8_t>(number);
    cell_->joint_of.back() = static_cast<std::int32_t>(cell_->joints.size());
    cell_->joints.push_back(joint);
    return node;
  }
  void add_geometry(std::int32_t node, const Mesh& mesh) {
    auto geometry = std::make_shared<Geometry>();
    geometry->shape = Shape::mesh;
    geometry->mesh = mesh;
    cell_->geometry.push_back({node, std::move(geometry)});
  }
  void add_fixed(const Mesh& mesh, const Vector3d& at, const Vector3d& rpy) {
    add_geometry(add_node(0, pose_from_xyz_rpy(at, rpy), "THING_" + std::to_string(names_.size())), mesh);
  }

  std::shared_ptr<CompiledCell> cell_ = std::make_shared<CompiledCell>();
  std::vector<std::string> names_;
  std::vector<std::int32_t> links_;
};

}  // namespace

std::shared_ptr<const CompiledCell> bench_cell() {
  Builder builder;
  builder.add_environment();
  builder.fix();
  builder.add_arms();
  builder.add_sensors();
  return builder.done();
}

std::size_t triangles_of(const CompiledCell& cell) {
  std::size_t out = 0;
  for (const CompiledGeometry& part : cell.geometry) out += part.geometry->mesh->triangles.size();
  return out;
}

std::vector<JointValues> bench_posture(std::size_t tick) {
  std::vector<JointValues> q(kBenchArms);
  const double time = 1e-3 * static_cast<double>(tick);
  for (std::size_t arm = 0; arm < kBenchArms; ++arm) {
    for (std::size_t joint = 0; joint < kBenchLinks; ++joint) {
      const double phase = 1.7 * static_cast<double>(arm) + 0.9 * static_cast<double>(joint);
      q[arm][joint] = 0.7 * std::sin(time / 0.7 + phase);
    }
  }
  return q;
}

std::shared_ptr<const geometry::TriangleMesh> bench_rock() {
  auto mesh = std::make_shared<geometry::TriangleMesh>();
  add_surface(*mesh, 256, 201, [](double u, double v) {
    const double angle = 2.0 * std::numbers::pi * u;
    const double polar = std::numbers::pi * (0.001 + 0.998 * v);
    const double r = 1.0 + 0.08 * std::sin(7.0 * angle) * std::sin(9.0 * polar) + 0.01 * std::sin(60.0 * polar);
    return Vector3d(r * std::sin(polar) * std::cos(angle), r * std::sin(polar) * std::sin(angle), r * std::cos(polar));
  });
  return mesh;
}

}  // namespace cellmirror
