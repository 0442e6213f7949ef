// Voxel volumes in the picture: rays are cast on the processor (rt_core/volume), their picture is laid over what is
// opaque by its depth. Private to this folder.
#pragma once

#include <vector>

#include "drivers/display/internal/render_target.hpp"
#include "drivers/display/internal/shader_program.hpp"
#include "drivers/display/internal/volume/volume_casting.hpp"

namespace cellmirror::display {

class VolumeLayer {
 public:
  VolumeLayer(const GlApi& gl, int threads) : gl_(gl), casting_(threads), over_(gl), depth_(gl) {}
  ~VolumeLayer();
  VolumeLayer(const VolumeLayer&) = delete;
  VolumeLayer& operator=(const VolumeLayer&) = delete;

  // See VolumeCasting::begin().
  void begin(const Scene& scene, Nanoseconds time) { casting_.begin(scene, time); }
  // After all that is opaque: reads its depth back, lays the volumes over it, and writes depth where they are at least
  // half opaque, for what is drawn later. Nothing without volumes.
  Result<void> draw(const Frame& frame, std::size_t pane, RenderTarget& target);
  // Puts the number of a volume where it is at least half opaque before what is in `objects`. `depth` is of the
  // picture.
  void pick(const Frame& frame, std::span<const float> depth, int width, std::span<std::uint32_t> objects);
  [[nodiscard]] const VolumeCounts& counts() const { return casting_.counts(); }

 private:
  Result<void> build();
  void upload(const volume::VolumePicture& picture);

  const GlApi& gl_;
  VolumeCasting casting_;
  ShaderProgram over_;
  ShaderProgram depth_;
  bool built_ = false;
  GLuint array_ = 0;
  GLuint colours_ = 0;
  GLuint depths_ = 0;
  std::vector<float> scene_depth_;
};

}  // namespace cellmirror::display
