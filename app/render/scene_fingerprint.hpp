// Tells whether a picture would look as the one before.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "rt_core/ports/scene.hpp"

namespace cellmirror::app {

// A hash of all that the scene shows from these panes, its time left out: equal scenes have equal ones. Not for
// safety: a collision would leave a picture unchanged for a second.
[[nodiscard]] std::uint64_t fingerprint(const Scene& scene, std::span<const Pane> panes);
// Of the voxel volumes alone: what they are, where, and how they are drawn.
[[nodiscard]] std::uint64_t volume_fingerprint(const Scene& scene);

// Of a text, for comparison only.
[[nodiscard]] std::uint64_t content_hash(std::string_view text);

}  // namespace cellmirror::app
