// What a renderer has drawn and holds.
#pragma once

#include <cstddef>
#include <cstdint>

namespace cellmirror {

struct RendererCounters {
  std::uint64_t frames = 0;
  std::uint64_t meshes = 0;           // uploaded now
  std::uint64_t uploads = 0;          // since the start: a mesh is uploaded once as long as it is in use
  std::uint64_t tissue_uploads = 0;   // since the start: triangles of deforming surfaces, again when they were cut
  std::uint64_t textures = 0;         // pictures of meshes, uploaded now
  std::uint64_t texture_uploads = 0;  // since the start: a picture is uploaded once as long as a mesh that uses it is
  std::uint64_t texture_bytes = 0;    // of those that are uploaded, with their smaller copies
  std::uint64_t bodies_drawn = 0;     // in the newest frame
  std::uint64_t bodies_left_out = 0;  // in the newest frame, by the visibility test
  // Voxel volumes of the newest frame; each counts once a pane.
  std::uint64_t volumes = 0;
  std::uint64_t volume_bricks = 0;
  std::uint64_t volume_bricks_drawn = 0;  // in which something is to be seen with the current table
  std::uint64_t volume_reduction = 0;     // edge of the square of pixels for which one ray stands; 0: none was cast
  bool volume_in_haste = false;           // drawn with less than full quality: another picture will be better
  std::uint64_t volume_ns = 0;            // time for casting
};

}  // namespace cellmirror
