// What a recording has of deformable objects: a message for the surface of each, and one for what is beside surfaces
// (clips, drops, smoke, the pool). Triangles, colours and shapes of clips are written when they change and from time to
// time, places in each message. Read from any bytes. Little endian; docs/recording.md has the layout. Not for the tick.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/tissue_state.hpp"

namespace cellmirror::app {

inline constexpr std::uint8_t kTissueVersion = 1;
// Of a surface or of all clips; what is beyond is not recorded, and refused where it is read.
inline constexpr std::size_t kMostRecordedVertices = 200'000;
inline constexpr std::size_t kMostRecordedTriangles = 400'000;
inline constexpr std::size_t kMostRecordedClips = 200;
inline constexpr std::size_t kMostRecordedParticles = 4096;

// Before each message of either kind.
struct TissueHead {
  std::uint64_t step = 0;      // of the simulation
  Timestamp time;              // of the instruments' posture, by the clock of the ticks
  std::uint32_t revision = 0;  // of the shapes; another number: other triangles, or clips
  bool has_shape = false;      // this message has them
};
[[nodiscard]] Result<TissueHead> read_tissue_head(std::span<const std::byte> message);

// Whether two messages say the same of another step.
[[nodiscard]] bool same_but_for_time(std::span<const std::byte> a, std::span<const std::byte> b);

// `out` is overwritten. False, where the surface cannot be recorded: it is larger than the bounds above, its parts do
// not fit together, or a vertex is not finite. Places are rounded to 1/65535 of the surface's box.
bool encode_surface(const TissueHead& head, const TissueSurface& surface, std::vector<std::byte>& out);

// What stays until the next message with a shape.
struct RecordedShape {
  std::uint32_t revision = 0;
  std::string name;  // of the object
  std::size_t vertices = 0;
  std::shared_ptr<const TissueTopology> topology;
};
// Fails where the message has none, or is not sound.
[[nodiscard]] Result<RecordedShape> read_shape(std::span<const std::byte> message);
// Fails where it is of another shape, or not sound. The surface has no look.
[[nodiscard]] Result<TissueSurface> read_surface(std::span<const std::byte> message, const RecordedShape& shape);

// What of a view is no surface. As above; what is not finite or beyond the bounds is left out.
void encode_tissue_effects(const TissueHead& head, const TissueView& view, std::vector<std::byte>& out);

struct RecordedClipShapes {
  std::uint32_t revision = 0;
  struct Shape {
    std::shared_ptr<const std::vector<Eigen::Vector3f>> vertices;
    std::shared_ptr<const std::vector<std::array<std::uint32_t, 3>>> triangles;
  };
  std::vector<Shape> shapes;  // by clip
};
[[nodiscard]] Result<RecordedClipShapes> read_clip_shapes(std::span<const std::byte> message);
// Everything of a view but surfaces and network. Clips of another revision are left out.
[[nodiscard]] Result<TissueView> read_tissue_effects(std::span<const std::byte> message,
                                                     const RecordedClipShapes& shapes);

}  // namespace cellmirror::app
