// What the gateway found out about bodies that touch or are near each other, and what range sensors read: plain data on
// its way to status, the SENSOR channel, DDS and the picture. SI, in the world frame. Made and read off the tick.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/light_barrier.hpp"

namespace cellmirror {

// Bodies are named by dotted path: that of the node whose geometry it is; the cell's own geometry by the cell's name.
using BodyNames = std::shared_ptr<const std::vector<std::string>>;

struct TouchingPoint {
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // unit vector from a to b
  double depth_m = 0;
};

// Two bodies that touch or overlap. `a` and `b` are indices into the names; a < b.
struct TouchingPair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  double depth_m = 0;  // of the deepest point
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  std::vector<TouchingPoint> points;
  bool doubtful = false;     // two ways of testing it disagree, or one could not settle it: treat it as touching
  Timestamp contact_time{};  // of the posture that depth, point, normal and points are for
};

struct NearPair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  double distance_m = 0;  // 0 for a pair that touches
  Eigen::Vector3d point_a_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d point_b_m = Eigen::Vector3d::Zero();
  bool within_warning = false;              // entered, and has not left yet
  bool doubtful = false;                    // the distance is a lower bound
  std::optional<double> closing_speed_m_s;  // positive: they approach; none where neither of them moves
  std::optional<double> time_to_contact_s;  // at present velocities; none where they do not approach
};

enum class ProximityChange : std::uint8_t { entered_warning, touched, parted, left_warning };

struct ProximityEvent {
  std::uint64_t sequence = 0;  // counts from 1
  ProximityChange change = ProximityChange::entered_warning;
  std::string a;
  std::string b;
  double distance_m = 0;
  Timestamp posture_time;    // of its posture
  std::string short_a = {};  // for people and records, as ProximityState::short_name(); empty: as `a`
  std::string short_b = {};
};

// One computation. Everything in it is for the posture of `posture_time`, except lasting contacts, which may be older
// and carry their own time.
struct ProximityState {
  Timestamp posture_time;  // the tick's instant
  Timestamp finished;      // when the computation ended
  std::uint64_t sequence = 0;
  BodyNames names;
  BodyNames short_names;  // of the same bodies; null: as `names`
  double warning_distance_m = 0;
  std::size_t pairs = 0;               // that are tested
  std::vector<TouchingPair> touching;  // in the order of a, then b
  std::vector<NearPair> near;          // nearest first: all within the warning distance, and at least the nearest pair
  std::vector<ProximityEvent> events;  // since the computation before, oldest first
  std::vector<std::string> doubts;     // what could not be computed for sure, in words; empty: all is certain

  // The smallest distance of all tested pairs; null where there is no pair. 0 where bodies touch.
  [[nodiscard]] const NearPair* nearest() const { return near.empty() ? nullptr : &near.front(); }
  // Shorter than the path where that is possible, as different as paths are, and accepted by commands. `body` is one of
  // the names.
  [[nodiscard]] const std::string& short_name(std::uint32_t body) const {
    return short_names ? (*short_names)[body] : (*names)[body];
  }
};

struct RangeReading {
  std::string id;                                     // name of the sensor's workframe (SET_USSPAR)
  std::string path;                                   // dotted path of the workframe
  Timestamp posture_time;                             // the tick's instant
  std::optional<double> distance_m;                   // from the apex; none: nothing in the cone up to the range
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();  // on the surface; where there is a distance
  std::string object;                                 // dotted path of the body; empty without an echo
  std::string short_object = {};                      // its short name; empty: as `object`
  bool in_blind_zone = false;                         // nearer than a real sensor of this kind can measure
  // A pose was not a finite number, or the shape of something in the cell is not known: something nearer may be there.
  bool doubtful = false;
  double range_m = 0;
  double blind_zone_m = 0;
  double half_angle_rad = 0;
  Pose X_WS = Pose::Identity();  // the workframe at posture_time: apex at its origin, the cone opens along its z axis
};

// SET_USSPAR sendmode (manual 1.2.1).
enum class RangeSendMode : std::uint8_t { one_message_a_sensor = 0, one_message_for_all = 1 };

// Receives results outside the tick. One calling thread (the publisher). Never blocks for long; what cannot be
// delivered is dropped and counted by the implementation.
class FindingsOutput {
 public:
  virtual ~FindingsOutput() = default;
  virtual void publish_proximity(const ProximityState& state) = 0;
  // `readings`: of the active sensors.
  virtual void publish_ranges(std::span<const RangeReading> readings, RangeSendMode mode) = 0;
  // All light barriers of the cell, always in the same order.
  virtual void publish_barriers(std::span<const BarrierReading> /*barriers*/) {}
};

}  // namespace cellmirror
