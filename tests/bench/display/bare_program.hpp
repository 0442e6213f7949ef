// A program that draws one mesh with OSMesa and nothing else, as one would write it by hand: the yardstick of
// display_bench. It shares no code with drivers/display.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

namespace cellmirror::bench {

struct BareMesh {
  std::vector<float> vertices;  // position and normal, six a vertex
  std::vector<std::uint32_t> corners;
};

class BareProgram {
 public:
  // samples: 0 or 4. matrix: clip from mesh, columns first.
  static std::unique_ptr<BareProgram> make(const BareMesh& mesh, int width, int height, int samples);
  virtual ~BareProgram() = default;
  virtual void draw(const float* matrix, std::vector<std::uint8_t>& rgba) = 0;
};

}  // namespace cellmirror::bench
