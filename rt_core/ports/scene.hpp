// What a renderer draws: plain data made from the cell and from what is known about it (rt_core/scene makes it,
// drivers/display draws it). SI, world frame unless said. Colours are red, green, blue, alpha, 0 to 1, sRGB.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/display_state.hpp"
#include "rt_core/ports/view.hpp"
#include "rt_core/ports/volume_settings.hpp"
#include "rt_core/ports/volume_user_table.hpp"

namespace cellmirror {

namespace geometry {
struct TriangleMesh;
}
enum class Shape : std::uint8_t;
struct MeshAppearance;
struct TissueView;
struct VoxelGrid;

using Colour = std::array<float, 4>;

// Highlight of a body or line; the renderer has one colour-blind safe style for each.
enum class Mark : std::uint8_t {
  none,
  near,  // within the warning distance of another body
  touching,
  ghost,  // of a mirrored robot whose data are stale or lost: drawn pale and dashed or see-through
};

struct SceneBody {
  std::uint32_t object = 0;  // what a pick answers: index of the node in the cell, plus 1; 0: nothing
  Shape shape{};             // sizes as Geometry (rt_core/cell/geometry.hpp)
  Eigen::Vector3d size = Eigen::Vector3d::Ones();
  std::shared_ptr<const geometry::TriangleMesh> mesh;  // Shape::mesh, scale applied; the same pointer: the same upload
  std::shared_ptr<const MeshAppearance> look;  // of the mesh, shown with DisplayMode::textures; null: it has none
  Pose X_WG = Pose::Identity();
  Colour rgba{0.72F, 0.72F, 0.74F, 1.0F};
  DrawMode mode = DrawMode::gouraud;
  Mark mark = Mark::none;
  bool casts_shadow = true;
};

// Three axes from its origin: x red, y green, z blue.
struct SceneAxes {
  Pose X_WF = Pose::Identity();
  double length_m = 0.25;
  bool emphasized = false;  // TCP and ZP frame of the active robot: thicker
  std::string name;         // drawn at its origin; may be empty
};

struct SceneLine {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
  Colour rgba{0, 0, 0, 1};
  float width_px = 1.5F;
  bool dashed = false;
  bool on_top = false;       // not hidden by bodies before it
  std::uint32_t camera = 0;  // as Pane::camera; not 0: left out in panes of this camera
};

// A curve through `points`, oldest first, older parts paler.
struct SceneTrace {
  std::vector<Eigen::Vector3f> points;
  Colour rgba{0, 0, 0, 1};
};

// The cone of a sensor: apex at the origin of S, opening along its z axis; see-through.
struct SceneCone {
  Pose X_WS = Pose::Identity();
  double half_angle_rad = 0;
  double length_m = 0;
  Colour rgba{0, 0, 0, 0.2F};
};

struct SceneArrow {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  Eigen::Vector3d along = Eigen::Vector3d::Zero();  // m: already scaled to a length in the world
  Colour rgba{0, 0, 0, 1};
  bool torque = false;  // with a double head
};

// The spark of ARC: flickers with its phase.
struct SceneSpark {
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  std::uint32_t phase = 0;
};

// Text at a point of the world, readable from anywhere, never hidden.
struct SceneLabel {
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  std::string text;  // UTF-8, one line
  Mark mark = Mark::none;
  std::uint32_t camera = 0;  // as SceneLine::camera
};

// The level top of a slab that the cell itself stands on: shadows fall on it as on the floor (SHAD, FLDR), which it
// hides. A rectangle along the axes of the world.
struct ShadowCatcher {
  double z_m = 0;
  Eigen::Vector2d low = Eigen::Vector2d::Zero();
  Eigen::Vector2d high = Eigen::Vector2d::Zero();
};

// A voxel volume: cast by rays into the picture, hidden by what is before it.
struct SceneVolume {
  std::uint32_t object = 0;  // as SceneBody::object
  std::shared_ptr<const VoxelGrid> grid;
  Pose X_WV = Pose::Identity();
  VolumeSettings settings;
  std::uint64_t tables_revision = 0;  // another one after VV_RELOAD_LUTS
  // USER1_LUT, USER2_LUT as last read; null: the built-in one.
  VolumeUserTables user_tables;
};

struct LegendEntry {
  Colour rgba{0, 0, 0, 1};
  std::string text;
};

struct Scene {
  Timestamp posture_time;
  std::vector<SceneBody> bodies;
  std::vector<SceneVolume> volumes;
  std::vector<SceneAxes> axes;
  std::vector<SceneLine> lines;
  std::vector<SceneTrace> traces;
  std::vector<SceneCone> cones;
  std::vector<SceneArrow> arrows;
  std::vector<SceneSpark> sparks;
  std::vector<SceneLabel> labels;
  std::vector<LegendEntry> legend;    // empty: none is drawn
  std::vector<std::string> messages;  // over the picture, newest last
  // Of the modes only these are the renderer's: backface_removal, cpu_backface_removal, two_sided_light, floor,
  // shadows, visibility_test, textures, antialiasing.
  DisplayModes modes;
  double floor_z_m = 0;
  Eigen::Vector2d floor_low = Eigen::Vector2d(-1, -1);  // that the floor has to reach at least
  Eigen::Vector2d floor_high = Eigen::Vector2d(1, 1);
  std::vector<ShadowCatcher> shadow_catchers;
  // Deforming objects, fluids and particles; null: none. Of its network the nodes and links are drawn from here, its
  // forces and central nodes from `arrows` and `axes`. What disagrees in size or is not finite is left out. The same
  // pointer: the same upload.
  std::shared_ptr<const TissueView> tissue;
  std::vector<DrawMode> tissue_modes;  // by surface; beyond its end: gouraud
};

// A part of the picture with an eye of its own. 0 to 1 of the picture, origin at its upper left corner.
struct Pane {
  double left = 0;
  double top = 0;
  double width = 1;
  double height = 1;
  int view = 0;              // 0 to 6; -1: a free one
  std::string title;         // drawn in its corner; may be empty
  std::uint32_t camera = 0;  // of the pane's camera: index of its node in the cell, plus 1; 0: none
  Eye eye;
};

}  // namespace cellmirror
