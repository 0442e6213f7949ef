// Casts the volumes of a scene into a picture of a pane, at the resolution that there is time for. Private to this
// folder; no OpenGL.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "drivers/display/internal/frame.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/voxel_grid.hpp"
#include "rt_core/volume/caster.hpp"

namespace cellmirror::display {

struct VolumeCounts {
  std::uint64_t volumes = 0;
  std::uint64_t bricks = 0;
  std::uint64_t bricks_drawn = 0;
  std::uint64_t reduction = 0;  // pixels along the edge of the square for which one ray stands; 0: nothing was cast
  bool hasty = false;           // reduced in any way: longer steps, earlier end, fewer rays
  Nanoseconds took{0};
};

class VolumeCasting {
 public:
  explicit VolumeCasting(int threads) : caster_(threads) {}

  // Before the panes of a picture: forgets data of volumes that are not in the scene any more. `time`: how long casting
  // may take in this picture while what is seen changes from one picture to the next; 0: as long as full quality takes.
  void begin(const Scene& scene, Nanoseconds time);
  struct Cast {
    const volume::VolumePicture* picture = nullptr;  // until the next call; null where there is nothing to be seen
    int reduction = 1;                               // edge of the square of pixels for which a pixel of it stands
  };
  // All volumes of the scene, the farthest first, each over those behind it. `depth`: of the pane's pixels.
  Cast cast(const Frame& frame, std::size_t pane, std::span<const float> depth);
  // With what is seen of each volume for itself: its picture with the object's number, at full quality.
  struct Seen {
    std::uint32_t object = 0;
    const volume::VolumePicture* picture = nullptr;
  };
  void cast_each(const Frame& frame, std::span<const float> depth, const std::function<void(const Seen&)>& take);
  [[nodiscard]] const VolumeCounts& counts() const { return counts_; }

 private:
  // What decides how volumes look in a pane.
  struct View {
    Eigen::Matrix4d clip_from_world = Eigen::Matrix4d::Identity();
    std::vector<SceneVolume> volumes;
    std::uint64_t depth = 0;  // hash
    [[nodiscard]] bool same(const View& other) const;
  };
  // A pane that is drawn again and again.
  struct Slot {
    std::size_t pane = 0;
    std::uint32_t camera = 0;
    int width = 0;
    int height = 0;
    View seen;
    bool complete = false;  // the picture is of full quality
    double full_s = 0;      // what full quality takes, estimated; 0: unknown
    int reduction = 1;
    std::uint64_t used = 0;  // picture number
    volume::VolumePicture picture;
    VolumeCounts counts;
  };

  Slot& slot_of(const Frame& frame, std::size_t pane);
  [[nodiscard]] static int reduction_for(double full_s, double time_s);
  void cast_into(Slot& slot, const Frame& frame, std::span<const float> depth, int reduction, bool hasty);
  volume::CastRequest request_of(const SceneVolume& shown, const Frame& frame, int reduction) const;

  volume::Caster caster_;
  SystemClock clock_;
  double time_s_ = 0;
  std::uint64_t picture_ = 0;
  std::vector<std::unique_ptr<Slot>> slots_;
  std::vector<float> depth_;  // of the reduced picture
  volume::VolumePicture one_;
  VolumeCounts counts_;  // of this picture
};

// Corners of the volume's box, W.
[[nodiscard]] std::array<Eigen::Vector3d, 8> corners_of(const SceneVolume& shown);

}  // namespace cellmirror::display
