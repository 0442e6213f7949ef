// The places where a piece of an instrument may come to touch a piece of its surroundings.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "rt_core/contact_model/pieces.hpp"
#include "rt_core/geometry/proximity.hpp"

namespace cellmirror::contact_model {

// The instrument is free as long as normal . displacement of `point` + gap >= 0. World frame.
struct Candidate {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();   // unit vector, towards the instrument
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    // m, on the instrument
  Eigen::Vector3d surface = Eigen::Vector3d::Zero();  // m, on the obstacle
  double gap = 0;                                     // m, along the normal
  double distance = 0;                                // m, of the features; what is nearer counts first
  std::int32_t node = 0;                              // that `point` is fixed to
};

enum class QueryResult : std::uint8_t {
  done,
  crowded,    // more contact points than capacity: repeat with less reach
  uncertain,  // something could not be settled
};

class PairQuery {
 public:
  explicit PairQuery(double margin);

  // Appends what is nearer than `reach`, m. A pair that overlaps by more than its skins is represented by one piece of
  // each body: `with_overlap`. No heap memory in steady state.
  QueryResult ask(const Piece& instrument, const Piece& obstacle, double reach, bool with_overlap,
                  std::vector<Candidate>& out);
  // Of the last pair: places that nearer ones bar well, but perhaps not on long ways.
  [[nodiscard]] std::span<const Candidate> refused() const { return refused_; }
  // Whether the last pair overlapped so that its depth was, or would have been, computed.
  [[nodiscard]] bool overlapped() const { return overlapped_; }

 private:
  static constexpr std::uint32_t kNone = ~0U;
  static constexpr std::size_t kMost = 768;  // places of one pair of pieces
  // The nearest points of two pieces, or of two of their triangles, without the skins. World frame.
  struct Touch {
    Eigen::Vector3d p_I;
    Eigen::Vector3d p_O;
    std::uint32_t triangle_I = kNone;
    std::uint32_t triangle_O = kNone;
  };
  struct ObstaclePlace {
    Eigen::Vector3d normal;  // of the surface there
    bool nearest = false;    // its surroundings are no nearer
    bool face = false;
    bool behind = false;  // the instrument sees the surface from inside
  };

  void primitive_near_primitive(const Piece& instrument, const Piece& obstacle);
  void mesh_near_primitive(const Piece& instrument, const Piece& obstacle);  // whichever of them is the mesh
  void mesh_near_mesh(const Piece& instrument, const Piece& obstacle);
  void consider(const Piece& instrument, const Piece& obstacle, const Touch& touch);
  [[nodiscard]] ObstaclePlace query_obstacle(const Piece& obstacle, const Touch& touch, const Eigen::Vector3d& d,
                                             double distance);
  [[nodiscard]] bool nearest_on_instrument(const Piece& instrument, const Touch& touch, const Eigen::Vector3d& d);
  void add_ends(const Piece& instrument, const Piece& obstacle, const Touch& touch, const Candidate& found);
  [[nodiscard]] bool over_face(const Piece& obstacle, std::uint32_t triangle, const Eigen::Vector3d& p_W) const;
  [[nodiscard]] bool one_in_the_other(const Piece& instrument, const Piece& obstacle) const;
  void keep_what_fits(std::vector<Candidate>& out);
  void overlap(const Piece& instrument, const Piece& obstacle, std::vector<Candidate>& out);
  void push(std::vector<Candidate>& list, const Candidate& candidate);

  double margin_;
  double reach_ = 0;
  Pose X_OW_ = Pose::Identity();  // the world in the obstacle's piece, and in the instrument's
  Pose X_IW_ = Pose::Identity();
  bool crowded_ = false;
  bool certain_ = true;
  bool overlapped_ = false;
  double nearest_ = 0;                                       // m, of the places seen in this query
  bool perhaps_inside_ = false;                              // what is nearest shows its back
  Eigen::Vector3d nearest_point_ = Eigen::Vector3d::Zero();  // that would be inside then
  std::vector<Candidate> near_;                              // true nearest points
  std::vector<Candidate> only_reference_;  // true nearest points of the obstacle, but not of the whole instrument
  std::vector<Candidate> planes_;          // of triangles whose nearest point is not the nearest of its surroundings
  std::vector<Candidate> refused_;
  geometry::Contact contact_;
};

}  // namespace cellmirror::contact_model
