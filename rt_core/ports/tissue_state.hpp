// What the simulation of tissue publishes: plain data for pictures, page, status and messages. SI, world frame.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/mesh_appearance.hpp"
#include "rt_core/ports/tissue_settings.hpp"

namespace cellmirror {

// What stays of a deforming surface while nothing is cut: immutable, shared; another `revision`: other triangles.
struct TissueTopology {
  std::uint64_t revision = 0;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise from outside
  std::vector<std::uint8_t> cut_face;                   // by triangle; 1: made by a cut or a tear, drawn as raw flesh
  std::vector<Eigen::Vector2f> texture;                 // by vertex; empty: none
  std::vector<std::array<float, 3>> rgb;                // by vertex, sRGB 0 to 1
};

struct TissueSurface {
  std::string name;  // of the object
  std::shared_ptr<const TissueTopology> topology;
  std::vector<Eigen::Vector3f> vertices;  // m, world
  std::vector<Eigen::Vector3f> normals;   // unit
  std::vector<float> burn;                // by vertex: 0 raw, 1 coagulated, 2 charred
  bool visible = true;
  bool wet = true;
  std::shared_ptr<const MeshAppearance> look;  // its first picture is the texture; may be null
};

enum class TissueNodeKind : std::uint8_t { inner, outer, contact, fixed };

// The network of eladyn_show_def 1.
struct TissueNetwork {
  std::vector<Eigen::Vector3f> nodes;
  std::vector<TissueNodeKind> kinds;                   // by node
  std::vector<std::array<std::uint32_t, 2>> links;     // into nodes
  std::vector<std::array<Eigen::Vector3f, 2>> forces;  // from, vector in N
  std::vector<Pose> central_nodes;                     // one an object
};

struct TissueParticle {
  Eigen::Vector3f at = Eigen::Vector3f::Zero();
  float radius_m = 0.001F;
  std::uint8_t kind = 0;  // 0 blood, 1 smoke, 2 water
  float age = 0;          // 0 new to 1 about to vanish
};

struct TissuePool {
  bool present = false;
  Pose X_WP = Pose::Identity();  // middle of the rectangle at level 0, z upwards
  Eigen::Vector2f size_m = Eigen::Vector2f::Zero();
  double level_m = 0;
  double blood = 0;              // share of blood, 0 to 1
  std::array<float, 4> rgba{};   // as it is drawn: with its blood
  std::uint16_t columns = 0;     // of the grid of heights, along x; the outermost ones lie on the edges
  std::vector<float> heights_m;  // above the level: row by row, from the lowest y; empty: level
};

// A clip that was placed.
struct TissueClip {
  Pose X_WC = Pose::Identity();
  std::shared_ptr<const std::vector<Eigen::Vector3f>> vertices;  // in C
  std::shared_ptr<const std::vector<std::array<std::uint32_t, 3>>> triangles;
  bool closes_vessel = false;
};

struct TissueEvent {
  std::uint64_t number = 0;  // counted from 1
  Timestamp time;
  TissueEventKind kind{};
  std::int16_t instrument = -1;  // slot of the robot; -1: none
  std::int16_t object = -1;
  TissueLimit limit{};  // of kind limit
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  // Points gripped; N at release or slip; m along the vessel to a clip; m2 cut or torn, N where a connection tears;
  // share coagulated (0: it begins); ml/min bled; or the value beyond a limit (SI).
  double value = 0;
  std::array<char, 24> part{};  // vessel or connection concerned; zero-terminated
};

[[nodiscard]] inline std::string_view part_of(const TissueEvent& event) {
  const auto end = std::ranges::find(event.part, '\0');
  return {event.part.data(), static_cast<std::size_t>(end - event.part.begin())};
}

struct TissueObjectState {
  std::string name;
  std::uint32_t nodes = 0;
  std::uint32_t elements = 0;
  std::uint32_t elements_at_start = 0;
  std::uint16_t attributes = 0;
  std::uint32_t substeps = 1;
  double added_mass_share = 0;  // mass that was added for a stable step, of all
  double volume_m3 = 0;
  std::uint32_t contacts = 0;
  std::uint32_t inverted = 0;   // elements turned inside out at the moment
  std::uint32_t parts = 1;      // pieces that are not connected
  double energy_j = 0;          // elastic
  double coagulated_share = 0;  // of the volume
};

struct TissueInstrumentState {
  std::int16_t slot = -1;
  InstrumentKind kind{};
  bool acting = false;  // its condition is true
  std::uint32_t contacts = 0;
  std::uint32_t held = 0;                              // points that its jaws hold
  Eigen::Vector3d force_W = Eigen::Vector3d::Zero();   // N, of the tissue on the instrument
  Eigen::Vector3d torque_W = Eigen::Vector3d::Zero();  // Nm about the tool centre point
};

struct TissueVesselState {
  std::string object;
  std::string name;
  std::uint8_t kind = 0;  // VesselKind
  bool severed = false;
  std::uint32_t clips = 0;
  double bleeding_ml_min = 0;
};

struct TissueState {
  std::uint64_t step = 0;
  Timestamp time;           // of the instruments' posture that it was computed for
  bool calculating = true;  // eladyn_calc
  std::vector<TissueObjectState> objects;
  std::vector<TissueInstrumentState> instruments;
  std::vector<TissueVesselState> vessels;
  std::vector<TissueEvent> events;                      // the last ones, oldest first; at most 64
  std::array<std::uint64_t, 10> event_counts{};         // by TissueEventKind
  std::array<std::uint64_t, kTissueLimits> excesses{};  // by TissueLimit
  std::array<bool, kTissueEffects> effects{};
  double bleeding_ml_min = 0;
  double blood_loss_ml = 0;
  double smoke = 0;     // 0 to 1
  double lens_fog = 0;  // 0 to 1
  std::uint32_t connections = 0;
  std::uint32_t connections_torn = 0;
  bool pool_present = false;
  double pool_level_m = 0;  // above its rectangle
  double pool_blood = 0;    // share of blood, 0 to 1
};

// For pictures: what TissueState counts, as shapes. Made at the rate of pictures, not of steps.
struct TissueView {
  std::uint64_t step = 0;
  std::vector<TissueSurface> surfaces;
  TissueNetwork network;  // empty unless it is shown
  std::vector<TissueParticle> particles;
  std::vector<TissueClip> clips;
  TissuePool pool;
  double smoke = 0;
  double lens_fog = 0;
};

}  // namespace cellmirror
