// Primitives as triangles. Private to this folder; no OpenGL.
#pragma once

#include "rt_core/geometry/triangle_mesh.hpp"

namespace cellmirror::display {

// All closed, of unit size and centred as rt_core/geometry/shape.hpp says.
[[nodiscard]] geometry::TriangleMesh unit_box();       // edges of 1
[[nodiscard]] geometry::TriangleMesh unit_cylinder();  // radius 1, length 1
[[nodiscard]] geometry::TriangleMesh unit_sphere();    // radius 1
[[nodiscard]] geometry::TriangleMesh unit_cone();      // base of radius 1 at z = 0, tip at z = 1
[[nodiscard]] geometry::TriangleMesh unit_funnel();    // apex at the origin, open ring of radius 1 at z = 1
[[nodiscard]] geometry::TriangleMesh capsule(double radius, double length);

}  // namespace cellmirror::display
