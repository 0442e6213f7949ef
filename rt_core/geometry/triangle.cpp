#include "rt_core/geometry/triangle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cellmirror::geometry {

namespace {

using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Squares of sines of angles of triangles. Below the first only the edges count: the rest lies within 1e-9 of them, in
// parts of the length. Below the second the normal is too coarse for a bound or an early end.
constexpr double kFlat = 1e-18;
constexpr double kThin = 1e-10;

// Written out: Eigen's own costs a call where it is not inlined, and these are the innermost loops of all queries.
double dot(const Vector3d& a, const Vector3d& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector3d cross(const Vector3d& a, const Vector3d& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
// NaN becomes 0.
double clamp01(double value) { return value > 0.0 ? (value < 1.0 ? value : 1.0) : 0.0; }

struct EdgePair {
  Vector3d p_a;
  Vector3d p_b;
  Vector3d gap;  // from p_a to p_b
  double squared = kInfinity;
};

// Of the segments a0 + s u and b0 + t v. The parameter s comes from cross products, not from Ericson's determinant of
// dot products: that one loses all digits at angles of 1e-8, this one at angles of 1e-15.
void closest_on_edges(const Vector3d& a0, const Vector3d& u, const Vector3d& b0, const Vector3d& v, EdgePair& out) {
  const double uu = dot(u, u);
  const double vv = dot(v, v);
  const double uv = dot(u, v);
  const Vector3d r = b0 - a0;
  const double ur = dot(u, r);
  const double vr = dot(v, r);
  const Vector3d n = cross(u, v);
  const double nn = dot(n, n);
  double s = nn > 1e-30 * uu * vv ? clamp01(dot(cross(r, v), n) / nn) : 0.0;
  double t = vv > 0.0 ? (uv * s - vr) / vv : -1.0;
  if (!(t >= 0.0)) {
    t = 0.0;
    s = uu > 0.0 ? clamp01(ur / uu) : 0.0;
  } else if (t > 1.0) {
    t = 1.0;
    s = uu > 0.0 ? clamp01((ur + uv) / uu) : 0.0;
  }
  out.p_a = a0 + s * u;
  out.p_b = b0 + t * v;
  out.gap = out.p_b - out.p_a;
  out.squared = dot(out.gap, out.gap);
}

ClosestPoints as_answer(const EdgePair& pair) { return {std::sqrt(pair.squared), pair.p_a, pair.p_b}; }

// A triangle with what its queries need again and again.
struct Face {
  const Triangle& corners;
  std::array<Vector3d, 3> edges;  // from corner i to corner i + 1
  Vector3d normal;                // of the length of twice the area
  double nn = 0;
  bool flat = false;
  bool thin = false;

  explicit Face(const Triangle& t) : corners(t), edges{t[1] - t[0], t[2] - t[1], t[0] - t[2]} {
    normal = cross(edges[0], edges[1]);
    nn = dot(normal, normal);
    const double square = dot(edges[0], edges[0]) * dot(edges[1], edges[1]);
    flat = !(nn > kFlat * square);
    thin = !(nn > kThin * square);
  }
};

// Whether the projection of p lies in the triangle (border included).
bool projects_inside(const Vector3d& p, const Face& face) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (dot(cross(face.edges[i], p - face.corners[i]), face.normal) < 0.0) return false;
  }
  return true;
}

// As a convex combination of the corners, so that it lies in the triangle whatever the rounding of the normal is.
Vector3d projection(const Vector3d& p, const Face& face) {
  const Triangle& t = face.corners;
  const double wa = std::max(0.0, dot(cross(face.edges[1], p - t[1]), face.normal));
  const double wb = std::max(0.0, dot(cross(face.edges[2], p - t[2]), face.normal));
  const double wc = std::max(0.0, dot(cross(face.edges[0], p - t[0]), face.normal));
  const double sum = wa + wb + wc;
  if (!(sum > 0.0)) return t[0];
  return t[0] + (wb / sum) * face.edges[0] - (wc / sum) * face.edges[2];
}

// The point in which a segment goes through the triangle, given the (scaled) heights of its ends over the plane.
bool pierces(const Vector3d& from, const Vector3d& to, double height_from, double height_to, const Face& face,
             Vector3d& at) {
  if ((height_from > 0.0) == (height_to > 0.0) && (height_from < 0.0) == (height_to < 0.0)) return false;
  const double difference = height_from - height_to;
  if (difference == 0.0) return false;
  at = from + (height_from / difference) * (to - from);
  return projects_inside(at, face);
}

// Heights of the corners of one triangle over the plane of another, times the length of that one's normal.
struct Heights {
  std::array<double, 3> over{};
  std::size_t nearest = 0;
  double smallest = 0;  // absolute; 0 where the corners stand on both sides, or the face is thin

  Heights(const Triangle& t, const Face& face) {
    const Vector3d& origin = face.corners[0];
    for (std::size_t i = 0; i < 3; ++i) over[i] = dot(t[i] - origin, face.normal);
    const bool above = over[0] > 0.0 && over[1] > 0.0 && over[2] > 0.0;
    const bool below = over[0] < 0.0 && over[1] < 0.0 && over[2] < 0.0;
    if (face.thin || !(above || below)) return;
    for (std::size_t i = 1; i < 3; ++i) {
      if (std::abs(over[i]) < std::abs(over[nearest])) nearest = i;
    }
    smallest = std::abs(over[nearest]);
  }
};

bool any_edge_pierces(const Triangle& t, const Heights& heights, const Face& face, Vector3d& at) {
  if (face.flat) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = i == 2 ? 0 : i + 1;
    if (pierces(t[i], t[next], heights.over[i], heights.over[next], face, at)) return true;
  }
  return false;
}

// A corner of t in the plane of the face: coplanar triangles that overlap without crossing edges.
bool any_corner_within(const Triangle& t, const Heights& heights, const Face& face, Vector3d& at) {
  if (face.flat) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    if (heights.over[i] == 0.0 && projects_inside(t[i], face)) {
      at = t[i];
      return true;
    }
  }
  return false;
}

// A corner of one over the inside of the other: nothing is nearer than that, so no edge needs to be examined.
bool corner_over_face(const Triangle& t, const Heights& heights, const Face& face, Vector3d& corner, Vector3d& foot) {
  if (heights.smallest <= 0.0) return false;
  corner = t[heights.nearest];
  if (!projects_inside(corner, face)) return false;
  foot = projection(corner, face);
  return true;
}

// The nearest points of the borders. Ends as soon as a pair of edges is found whose connection has each of the
// triangles wholly on its own side (Larsen, Gottschalk, Lin, Manocha 1999).
void closest_on_borders(const Face& a, const Face& b, EdgePair& best) {
  EdgePair pair;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d& opposite_a = a.corners[i == 0 ? 2 : i - 1];
    for (std::size_t k = 0; k < 3; ++k) {
      closest_on_edges(a.corners[i], a.edges[i], b.corners[k], b.edges[k], pair);
      if (!(pair.squared < best.squared)) continue;
      best = pair;
      const Vector3d& opposite_b = b.corners[k == 0 ? 2 : k - 1];
      if (dot(opposite_a - pair.p_a, pair.gap) <= 0.0 && dot(opposite_b - pair.p_b, pair.gap) >= 0.0) return;
    }
  }
}

// Every corner of t against the face.
void closest_to_face(const Triangle& t, const Face& face, bool face_is_a, EdgePair& best) {
  if (face.flat) return;
  for (const Vector3d& corner : t) {
    const double height = dot(corner - face.corners[0], face.normal);
    if (height * height >= best.squared * face.nn || !projects_inside(corner, face)) continue;
    const Vector3d foot = projection(corner, face);
    best.p_a = face_is_a ? foot : corner;
    best.p_b = face_is_a ? corner : foot;
    best.gap = best.p_b - best.p_a;
    best.squared = dot(best.gap, best.gap);
  }
}

ClosestPoints common_point(const Vector3d& p) { return {0.0, p, p}; }

}  // namespace

Vector3d closest_on_segment(const Vector3d& p, const Segment& s) CELL_RT {
  const Vector3d u = s.to - s.from;
  const double uu = dot(u, u);
  if (!(uu > 0.0)) return s.from;
  const double t = dot(p - s.from, u) / uu;
  if (t >= 1.0) return s.to;
  return s.from + clamp01(t) * u;
}

Vector3d closest_on_triangle(const Vector3d& p, const Triangle& t) CELL_RT {
  const Face face(t);
  Vector3d best = t[0];
  double squared = kInfinity;
  if (!face.flat && projects_inside(p, face)) {
    best = projection(p, face);
    if (!face.thin) return best;
    squared = (best - p).squaredNorm();
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d candidate = closest_on_segment(p, Segment{t[i], t[i == 2 ? 0 : i + 1]});
    const Vector3d gap = candidate - p;
    const double value = dot(gap, gap);
    if (!(value < squared)) continue;
    squared = value;
    best = candidate;
  }
  return best;
}

ClosestPoints segment_segment(const Segment& a, const Segment& b) CELL_RT {
  EdgePair pair;
  closest_on_edges(a.from, a.to - a.from, b.from, b.to - b.from, pair);
  return as_answer(pair);
}

ClosestPoints segment_triangle(const Segment& a, const Triangle& b) CELL_RT {
  const Face face(b);
  const Vector3d u = a.to - a.from;
  if (!face.flat) {
    Vector3d at;
    if (pierces(a.from, a.to, dot(a.from - b[0], face.normal), dot(a.to - b[0], face.normal), face, at)) {
      return common_point(at);
    }
  }
  EdgePair best;
  EdgePair pair;
  for (std::size_t i = 0; i < 3; ++i) {
    closest_on_edges(a.from, u, b[i], face.edges[i], pair);
    if (pair.squared < best.squared) best = pair;
  }
  if (!face.flat) {
    for (const Vector3d& end : {a.from, a.to}) {
      const double height = dot(end - b[0], face.normal);
      if (height * height >= best.squared * face.nn || !projects_inside(end, face)) continue;
      best.p_a = end;
      best.p_b = projection(end, face);
      best.gap = best.p_b - best.p_a;
      best.squared = dot(best.gap, best.gap);
    }
  }
  return as_answer(best);
}

ClosestPoints triangle_triangle(const Triangle& a, const Triangle& b, double up_to) CELL_RT {
  const Face face_b(b);
  const Heights heights_a(a, face_b);
  if (heights_a.smallest * heights_a.smallest > up_to * up_to * face_b.nn) {
    return {std::max(up_to, heights_a.smallest / std::sqrt(face_b.nn)), Vector3d::Zero(), Vector3d::Zero()};
  }
  const Face face_a(a);
  const Heights heights_b(b, face_a);
  if (heights_b.smallest * heights_b.smallest > up_to * up_to * face_a.nn) {
    return {std::max(up_to, heights_b.smallest / std::sqrt(face_a.nn)), Vector3d::Zero(), Vector3d::Zero()};
  }
  EdgePair best;
  if (corner_over_face(a, heights_a, face_b, best.p_a, best.p_b) ||
      corner_over_face(b, heights_b, face_a, best.p_b, best.p_a)) {
    return {(best.p_b - best.p_a).norm(), best.p_a, best.p_b};
  }
  if (heights_a.smallest == 0.0 && heights_b.smallest == 0.0) {
    Vector3d at;
    if (any_edge_pierces(a, heights_a, face_b, at) || any_edge_pierces(b, heights_b, face_a, at) ||
        any_corner_within(a, heights_a, face_b, at) || any_corner_within(b, heights_b, face_a, at)) {
      return common_point(at);
    }
  }
  closest_on_borders(face_a, face_b, best);
  if (best.squared > 0.0) {
    // A corner that is nearest to a face has its triangle on one side of it, and was found above; but for thin faces
    // and rounding.
    if (heights_a.smallest == 0.0) closest_to_face(a, face_b, false, best);
    if (heights_b.smallest == 0.0) closest_to_face(b, face_a, true, best);
  }
  return as_answer(best);
}

ClosestPoints triangle_triangle(const Triangle& a, const Triangle& b) CELL_RT {
  return triangle_triangle(a, b, kInfinity);
}

}  // namespace cellmirror::geometry
