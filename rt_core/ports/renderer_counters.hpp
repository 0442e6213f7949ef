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
};

}  // namespace cellmirror
