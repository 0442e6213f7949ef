// The colours with a meaning in the picture and its legend, distinguishable for colour-blind users by lightness. sRGB.
#pragma once

#include "rt_core/ports/scene.hpp"
#include "rt_core/ports/tissue_state.hpp"

namespace cellmirror::palette {

inline constexpr Colour kNear{0.95F, 0.72F, 0.12F, 1.0F};
inline constexpr Colour kTouching{0.80F, 0.22F, 0.04F, 1.0F};
inline constexpr Colour kGhost{0.52F, 0.56F, 0.66F, 0.45F};
inline constexpr Colour kRange{0.34F, 0.71F, 0.91F, 0.22F};  // cones of sensors
inline constexpr Colour kBeam{0.42F, 0.76F, 0.30F, 1.0F};    // of light barriers
inline constexpr Colour kBeamInterrupted{0.72F, 0.10F, 0.36F, 1.0F};
inline constexpr Colour kTrace{0.00F, 0.45F, 0.70F, 1.0F};
inline constexpr Colour kForce{0.00F, 0.50F, 0.38F, 1.0F};
inline constexpr Colour kTorque{0.62F, 0.30F, 0.52F, 1.0F};
inline constexpr Colour kPyramid{0.25F, 0.28F, 0.36F, 1.0F};
inline constexpr Colour kSpark{1.00F, 0.93F, 0.70F, 1.0F};
inline constexpr Colour kInnerNode{0.86F, 0.88F, 0.92F, 1.0F};  // of deforming objects
inline constexpr Colour kOuterNode{0.00F, 0.45F, 0.70F, 1.0F};
inline constexpr Colour kContactNode{0.94F, 0.78F, 0.10F, 1.0F};
inline constexpr Colour kFixedNode{0.10F, 0.10F, 0.12F, 1.0F};
inline constexpr Colour kTissueForce{0.40F, 0.18F, 0.62F, 1.0F};

[[nodiscard]] constexpr Colour colour_of(TissueNodeKind kind) {
  switch (kind) {
    case TissueNodeKind::outer:
      return kOuterNode;
    case TissueNodeKind::contact:
      return kContactNode;
    case TissueNodeKind::fixed:
      return kFixedNode;
    case TissueNodeKind::inner:
      break;
  }
  return kInnerNode;
}

[[nodiscard]] constexpr Colour opaque(Colour colour) {
  colour[3] = 1.0F;
  return colour;
}

}  // namespace cellmirror::palette
