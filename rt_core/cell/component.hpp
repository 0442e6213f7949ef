// What a component file (an ABSTRACT file: .mpc or .urdf) or a cell file says, as immutable plain data. One file that
// is used several times in a cell is read once and shared. Every node below is given as in its file; the tree of the
// cell is made of it by Cell.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/pose.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/cell/geometry.hpp"
#include "rt_core/ports/robot_parameters.hpp"
#include "rt_core/ports/robot_state.hpp"
#include "rt_core/ports/volume_settings.hpp"
#include "rt_core/ports/voxel_grid.hpp"

namespace cellmirror {

enum class NodeKind : std::uint8_t {
  frame,
  joint,
  workframe,  // WFRM: a relative assembly pose for FRAME_TO_WFRM
  camera,     // a camera's workframe
  sensor,     // an ultrasonic sensor's workframe
};

// State of a part: shown by its own (detailed) geometry, by its father's geometry, or not at all.
enum class Shown : std::uint8_t { detail, coarse, hidden };

// Moments about the centre of mass, axes parallel to the node's.
struct BodyInertia {
  double mass_kg = 0;
  Eigen::Vector3d p_NC = Eigen::Vector3d::Zero();  // centre of mass in the node, m
  Eigen::Matrix3d I_C = Eigen::Matrix3d::Zero();   // kg m2
};

// The drive of a joint, for dynamics. Zero: not known.
struct JointDrive {
  double gear_ratio = 0;     // motor turns a joint turn (rad/m for prismatic joints); the sign is the sense of rotation
  double rotor_inertia = 0;  // kg m2, motor side
  double coulomb_friction = 0;  // Nm or N, joint side
  double viscous_friction = 0;  // Nm s/rad or N s/m, joint side
  double max_effort = 0;        // Nm or N, joint side
};

// value of this joint = multiplier * value of `joint` + offset; `joint` names a joint of the same file that is no
// mimic.
struct Mimic {
  std::string joint;
  double multiplier = 1.0;
  double offset = 0.0;
};

// SI: rad or m and their derivatives.
struct JointDefinition {
  JointKind kind = JointKind::revolute;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  // unit vector in the joint's own frame
  double min_position = 0;
  double max_position = 0;
  double start_position = 0;
  double reference_position = 0;
  double max_velocity = 0;
  double min_velocity = 0;
  double max_acceleration = 0;
  bool velocity_given = false;  // by the file; else it is a default, and says nothing about a real joint
  bool acceleration_given = false;
  JointDrive drive;
  std::optional<Mimic> mimic;
};

struct CameraDefinition {
  double focal_distance_m = 5.0;  // SET_CAMPAR's viewing distance
  double fovy_rad = 0.5;          // opening angle of the viewing pyramid
};

// An ultrasonic sensor; its cone opens along the z axis of its workframe.
struct SensorDefinition {
  double range_m = 3.0;
  double half_angle_rad = 0.13;
  double blind_zone_m = 0.1;
  bool active = false;  // at the start; SET_USSPAR active
  // The beam model of a real sensor; off by default.
  double max_incidence_rad = 1.5707963267948966;  // no echo beyond this angle to the surface's normal
  double noise_m = 0;                             // standard deviation of the reading
  std::uint64_t seed = 1;                         // of the noise
};

// The ABSTRACT file of a node.
struct AbstractReference {
  std::string file;        // as written; ComponentSource finds it
  bool loaded = true;      // at the start
  std::string robot_id;    // instead of the file's own; empty: the file's
  std::string robot_base;  // node names inside the component, instead of the file's; empty: the file's
  std::string robot_flange;
  // Of the component's meshes, where its file does not say otherwise.
  std::optional<CollideAs> collide_as = std::nullopt;
  int line = 0;  // where the file is named
  int column = 0;
};

struct ComponentNode {
  std::string name;
  NodeKind kind = NodeKind::frame;
  int parent =
      -1;  // index of the naming parent in the component, always smaller than its own; -1: the component's root
  std::string predecessor;       // cell files only: path of the kinematic predecessor; empty: the naming parent
  Pose X_PF = Pose::Identity();  // in the kinematic predecessor (for a joint: at position zero)
  std::vector<Geometry> geometry;
  std::optional<JointDefinition> joint;  // kind joint
  CameraDefinition camera;               // kind camera
  SensorDefinition sensor;               // kind sensor
  BodyInertia inertia;
  std::optional<AbstractReference> abstract;
  Shown shown = Shown::detail;  // at the start
  int line = 0;                 // where it stands in its file
  int column = 0;
};

struct RobotDefinition {
  std::string id;
  // Indices of nodes; -1: the component's root.
  int base = -1;
  int zero_point = -1;
  int flange = -1;
  std::vector<int> joints;               // nodes of the joints, in the order of the file, without mimics
  RobotParameters parameters;            // the file's values
  std::vector<KnownLimits> limits = {};  // of each joint, as far as the file gives them
  int line = 0;
  int column = 0;
};

// The voxel volume of a component.
struct ComponentVolume {
  std::shared_ptr<const VoxelGrid> grid;  // null: refused, or not read
  Pose X_CV = Pose::Identity();           // in the component's root
  VolumeSettings settings;                // at the start
};

struct Component {
  std::string file;  // for messages, and to notice that a component would contain itself
  std::string description;
  std::string name = {};           // of a cell file: the cell's; also that of its own geometry in results
  std::vector<Geometry> geometry;  // of the component's root
  BodyInertia inertia;             // of the component's root
  std::vector<ComponentNode> nodes;
  std::optional<RobotDefinition> robot;
  std::optional<ComponentVolume> volume;

  [[nodiscard]] Place place(const ComponentNode& node) const { return {file, node.line, node.column}; }
};

// Where ABSTRACT files come from; config/ implements it. Called on the thread that owns the cell.
class ComponentSource {
 public:
  virtual ~ComponentSource() = default;
  // The component in `file`, from memory where it is known already. An error says the first finding and how many there
  // are.
  virtual Result<std::shared_ptr<const Component>> component(std::string_view file) = 0;
  // The same as the reference wants it: two references with another `collide_as` are two components.
  virtual Result<std::shared_ptr<const Component>> component_for(const AbstractReference& reference) {
    return component(reference.file);
  }
};

}  // namespace cellmirror
