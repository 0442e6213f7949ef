#include "rt_core/volume/cast_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "rt_core/volume/bricks.hpp"

// With sanitizers, which do not see into gathers of the processor and compile this file for minutes otherwise: only the
// instruction set that every processor has, and calls instead of inlined code.
#ifdef CELLMIRROR_PLAIN_KERNELS
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX2 | HWY_AVX3)
#define CELLMIRROR_LARGE_INLINE HWY_NOINLINE
#else
#define CELLMIRROR_LARGE_INLINE HWY_INLINE
#endif
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rt_core/volume/cast_kernel.cpp"
// Compiles this file once for each instruction set; before all other headers of Highway.
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include <hwy/contrib/math/math-inl.h>

#include "rt_core/volume/cast_sampling.hpp"

HWY_BEFORE_NAMESPACE();
namespace cellmirror::volume::HWY_NAMESPACE {

struct Shade {
  V factor;  // of the colour
  V gloss;   // added to it
};

// Light from the eye: the share of light that a surface across the gradient throws back, as far as there is a surface.
CELLMIRROR_LARGE_INLINE Shade shade_of(const KernelJob& job, const Rays& rays, const Point& gradient, V lit) {
  const V tiny = set(1e-20F);
  const V dx = hn::Mul(rays.direction.x, set(1.0F / job.per_metre[0]));  // the ray's direction in V
  const V dy = hn::Mul(rays.direction.y, set(1.0F / job.per_metre[1]));
  const V dz = hn::Mul(rays.direction.z, set(1.0F / job.per_metre[2]));
  const V along = hn::MulAdd(dx, gradient.x, hn::MulAdd(dy, gradient.y, hn::Mul(dz, gradient.z)));
  const V square =
      hn::MulAdd(gradient.x, gradient.x, hn::MulAdd(gradient.y, gradient.y, hn::MulAdd(gradient.z, gradient.z, tiny)));
  const V length = hn::Sqrt(square);
  const V cosine = hn::Min(hn::Div(hn::Abs(along), length), set(1.0F));
  const V surface = hn::Mul(lit, hn::Min(hn::Mul(length, set(job.gradient_scale)), set(1.0F)));
  V power = hn::Mul(cosine, cosine);
  power = hn::Mul(power, power);
  power = hn::Mul(power, power);
  power = hn::Mul(power, power);
  power = hn::Mul(power, power);
  const V bright = hn::MulAdd(set(kDiffuse), cosine, set(kAmbient - 1.0F));
  return {hn::MulAdd(surface, bright, set(1.0F)), hn::Mul(hn::Mul(surface, power), set(kSpecular))};
}

struct Sum {
  V alpha, red, green, blue;
  V half_at;  // m: where it became half opaque; negative: nowhere
};

CELLMIRROR_LARGE_INLINE V byte_of(VI packed, int which) {
  const DU du;
  const auto bits = hn::BitCast(du, packed);
  const auto mask = hn::Set(du, 0xFFU);
  hn::Vec<DU> part;
  if (which == 0)
    part = hn::And(bits, mask);
  else if (which == 1)
    part = hn::And(hn::ShiftRight<8>(bits), mask);
  else if (which == 2)
    part = hn::And(hn::ShiftRight<16>(bits), mask);
  else
    part = hn::ShiftRight<24>(bits);
  return hn::Mul(hn::ConvertTo(D(), hn::BitCast(DI(), part)), set(1.0F / 255.0F));
}

HWY_INLINE VI table_place(const KernelJob& job, V value) {
  const V place = hn::MulAdd(value, set(job.table_scale), set(job.table_offset));
  return hn::ConvertTo(DI(), kept_within(place, job.table_last));
}

// Adds samples of which each has so much opacity, 0 where a lane is idle.
template <Stored kStored>
CELLMIRROR_LARGE_INLINE void add_sample(const KernelJob& job, const Rays& rays, const Point& p, V t, VI place, V alpha,
                                        Sum& sum) {
  const DI di;
  const VI packed = hn::GatherIndex(di, reinterpret_cast<const std::int32_t*>(job.colour), place);
  const V weight = hn::Mul(alpha, hn::Sub(set(1.0F), sum.alpha));
  V red = byte_of(packed, 0);
  V green = byte_of(packed, 1);
  V blue = byte_of(packed, 2);
  const V lit = byte_of(packed, 3);
  if (job.light && !hn::AllFalse(D(), hn::Gt(hn::Mul(weight, lit), set(kWorthLight)))) {
    const Shade shade = shade_of(job, rays, gradient_at<kStored>(job, p), lit);
    red = hn::MulAdd(red, shade.factor, shade.gloss);
    green = hn::MulAdd(green, shade.factor, shade.gloss);
    blue = hn::MulAdd(blue, shade.factor, shade.gloss);
  }
  sum.red = hn::MulAdd(weight, red, sum.red);
  sum.green = hn::MulAdd(weight, green, sum.green);
  sum.blue = hn::MulAdd(weight, blue, sum.blue);
  const V after = hn::Add(sum.alpha, weight);
  const V half = set(0.5F);
  sum.half_at = hn::IfThenElse(hn::And(hn::Lt(sum.alpha, half), hn::Ge(after, half)), t, sum.half_at);
  sum.alpha = after;
}

struct Leap {
  M empty;
  V to;  // m: the whole ray up to there shows nothing
};

HWY_INLINE V exit_along(V direction, V origin, V inverse, VI brick, VI reach) {
  const DI di;
  const D d;
  const V high = hn::ConvertTo(d, hn::ShiftLeft<kBrickShift>(hn::Add(brick, reach)));
  const V low = hn::ConvertTo(d, hn::ShiftLeft<kBrickShift>(hn::Sub(hn::Add(brick, hn::Set(di, 1)), reach)));
  const V bound = hn::IfThenElse(hn::Gt(direction, hn::Zero(d)), high, low);
  return hn::Mul(hn::Sub(bound, origin), inverse);
}

struct BrickPlace {
  VI x, y, z;
  VI leap;    // bricks; 0: something may be seen
  VI stride;  // binary logarithm of the steps at once
};

CELLMIRROR_LARGE_INLINE BrickPlace brick_at(const KernelJob& job, const Point& p) {
  const DI di;
  BrickPlace b;
  const VI i = hn::ConvertTo(di, kept_within(p.x, job.fine.largest[0]));
  const VI j = hn::ConvertTo(di, kept_within(p.y, job.fine.largest[1]));
  const VI k = hn::ConvertTo(di, kept_within(p.z, job.fine.largest[2]));
  b.x = hn::ShiftRight<kBrickShift>(i);
  b.y = hn::ShiftRight<kBrickShift>(j);
  b.z = hn::ShiftRight<kBrickShift>(k);
  const VI offset =
      hn::Add(b.x, hn::Add(hn::Mul(b.y, hn::Set(di, job.leap_row)), hn::Mul(b.z, hn::Set(di, job.leap_layer))));
  const VI code = hn::GatherIndex(di, reinterpret_cast<const std::int32_t*>(job.leap), offset);
  b.leap = hn::And(code, hn::Set(di, 0xF));
  // Of the 4 x 4 x 4 cells around, two bits.
  const VI block = hn::Or(hn::And(hn::ShiftRight<2>(i), hn::Set(di, 1)),
                          hn::Or(hn::And(hn::ShiftRight<1>(j), hn::Set(di, 2)), hn::And(k, hn::Set(di, 4))));
  b.stride = hn::And(hn::Shr(code, hn::Add(hn::Add(block, block), hn::Set(di, kStrideShift))), hn::Set(di, 3));
  return b;
}

CELLMIRROR_LARGE_INLINE V leap_end(const Rays& rays, const BrickPlace& b) {
  const V x = exit_along(rays.direction.x, rays.origin.x, rays.inverse.x, b.x, b.leap);
  const V y = exit_along(rays.direction.y, rays.origin.y, rays.inverse.y, b.y, b.leap);
  const V z = exit_along(rays.direction.z, rays.origin.z, rays.inverse.z, b.z, b.leap);
  return hn::Min(x, hn::Min(y, z));
}

// Of `count` steps from step `step` on.
HWY_INLINE V middle_of_steps(const KernelJob& job, const Rays& rays, V step, V count) {
  return hn::MulAdd(hn::MulAdd(count, set(0.5F), step), set(job.step_m), rays.begin);
}

// Bounded: where an eye is very far, the ends of a ray are not known that well.
HWY_INLINE V steps_of(const KernelJob& job, const Rays& rays) {
  const V steps = hn::Mul(hn::Sub(rays.end, rays.begin), set(1.0F / job.step_m));
  return hn::Min(hn::Max(steps, hn::Zero(D())), set(kMostSteps));
}

// The first step whose middle is not before t.
HWY_INLINE V step_at(const KernelJob& job, const Rays& rays, V t) {
  return hn::Ceil(hn::Sub(hn::Mul(hn::Sub(t, rays.begin), set(1.0F / job.step_m)), set(0.5F)));
}

// The opacity of 1, 2, 4 or 8 steps from that of one.
CELLMIRROR_LARGE_INLINE V opacity_of_steps(V alpha, VI stride_log) {
  const D d;
  const DI di;
  for (int i = 0; i < int{kLongestStrideLog}; ++i) {
    const M again = hn::RebindMask(d, hn::Gt(stride_log, hn::Set(di, i)));
    alpha = hn::IfThenElse(again, hn::NegMulAdd(alpha, alpha, hn::Add(alpha, alpha)), alpha);
  }
  return alpha;
}

// 2 to the power of 0 to 3.
HWY_INLINE V power_of_two(VI exponent) {
  const DI di;
  return hn::BitCast(D(), hn::ShiftLeft<23>(hn::Add(exponent, hn::Set(di, 127))));
}

// Samples between two looks at the bricks: values before what they look like.
struct Group {
  V t[kChecked];      // m
  V value[kChecked];  // as stored
  M counted[kChecked];
  VI stride_log;
  int samples = 0;
};

template <Stored kStored>
CELLMIRROR_LARGE_INLINE void add_group(const KernelJob& job, const Rays& rays, const Group& group, Sum& sum) {
  const D d;
  const M open = hn::Lt(sum.alpha, set(job.opaque));
  for (int i = 0; i < group.samples; ++i) {
    const VI place = table_place(job, group.value[i]);
    const V of_step = hn::GatherIndex(d, job.alpha, place);
    const V alpha = hn::IfThenElseZero(hn::And(open, group.counted[i]), of_step);
    if (hn::AllFalse(d, hn::Gt(alpha, hn::Zero(d)))) continue;
    add_sample<kStored>(job, rays, at(rays, group.t[i]), group.t[i], place, opacity_of_steps(alpha, group.stride_log),
                        sum);
  }
}

template <Stored kStored>
CELLMIRROR_LARGE_INLINE void march(const KernelJob& job, const Rays& rays, Sum& sum, TileCounts& counts) {
  const D d;
  const DI di;
  const V length = steps_of(job, rays);
  const V whole = hn::Floor(length);
  const V opaque = set(job.opaque);
  const V one = set(1.0F);
  V step = hn::Zero(d);
  M active = hn::Lt(step, whole);
  // The loads of a group, the look at the bricks after it and the colours of the group before do not wait for each
  // other: the processor overlaps them.
  Group groups[2];
  int turn = 0;
  const auto look = [&] { return brick_at(job, at(rays, middle_of_steps(job, rays, step, one))); };
  BrickPlace brick = look();
  while (!hn::AllFalse(d, active)) {
    const M empty = hn::RebindMask(d, hn::Gt(brick.leap, hn::Zero(di)));
    ++counts.leaps;
    // Lanes in empty bricks leap; if others are not, they sample meanwhile.
    if (!hn::AllFalse(d, hn::And(empty, active))) {
      const V leapt = hn::Max(hn::Add(step, one), step_at(job, rays, leap_end(rays, brick)));
      step = hn::IfThenElse(empty, leapt, step);
      if (hn::AllTrue(d, hn::Or(empty, hn::Not(active)))) {
        active = hn::And(active, hn::Lt(step, whole));
        brick = look();
        continue;
      }
    }
    const M sampling = hn::AndNot(empty, active);
    // Before the end only as many steps at once as are left there.
    const V left = hn::Sub(whole, step);
    const V wanted = power_of_two(brick.stride);
    const VI stride_log = hn::IfThenElseZero(hn::RebindMask(di, hn::And(sampling, hn::Le(wanted, left))), brick.stride);
    const V stride = power_of_two(stride_log);
    // Of long steps one between looks at the blocks: they end within its neighbours.
    const bool some_long = !hn::AllFalse(d, hn::Gt(stride, set(2.0F)));
    const bool some_double = !hn::AllFalse(d, hn::Gt(stride, set(1.0F)));
    const bool coarse =
        job.has_coarse && (job.all_coarse || hn::AllTrue(d, hn::Or(hn::Not(sampling), hn::Gt(stride, set(2.0F)))));
    Group& group = groups[turn];
    turn = 1 - turn;
    group.samples = some_long ? 1 : some_double ? kChecked / 2 : kChecked;
    group.stride_log = stride_log;
    for (int i = 0; i < group.samples; ++i) {
      const V t = middle_of_steps(job, rays, step, stride);
      const Point p = at(rays, t);
      const M counted = hn::And(sampling, hn::Le(hn::Add(step, stride), whole));
      group.t[i] = t;
      group.value[i] = coarse ? coarse_value_at<kStored>(job, p) : value_at<kStored>(job, p);
      group.counted[i] = counted;
      step = hn::IfThenElse(counted, hn::Add(step, stride), step);
    }
    counts.samples += static_cast<std::uint64_t>(group.samples) * kLanes;
    brick = look();
    add_group<kStored>(job, rays, groups[turn], sum);
    active = hn::And(active, hn::And(hn::Lt(step, whole), hn::Lt(sum.alpha, opaque)));
  }
  add_group<kStored>(job, rays, groups[1 - turn], sum);
  // What is left of a step at the end.
  const V rest = hn::Sub(length, whole);
  const M left = hn::And(hn::Gt(rest, set(1e-3F)), hn::Lt(sum.alpha, opaque));
  if (hn::AllFalse(d, left)) return;
  const V t = hn::MulAdd(hn::MulAdd(rest, set(0.5F), whole), set(job.step_m), rays.begin);
  const Point p = at(rays, t);
  const VI place = table_place(job, value_at<kStored>(job, p));
  const V depth = hn::Mul(hn::GatherIndex(d, job.depth, place), rest);
  const V alpha = hn::IfThenElseZero(left, hn::Sub(one, hn::Exp(d, hn::Neg(depth))));
  if (!hn::AllFalse(d, hn::Gt(alpha, hn::Zero(d)))) add_sample<kStored>(job, rays, p, t, place, alpha, sum);
}

template <Stored kStored>
HWY_INLINE M solid_at(const KernelJob& job, const Point& p) {
  const V value = value_at<kStored>(job, p);
  const V threshold = set(job.threshold);
  return job.falling ? hn::Le(value, threshold) : hn::Ge(value, threshold);
}

// Where rays pass into what is solid, lit.
template <Stored kStored>
CELLMIRROR_LARGE_INLINE void find_surface(const KernelJob& job, const Rays& rays, Sum& sum, TileCounts& counts) {
  const D d;
  const DI di;
  const V one = set(1.0F);
  const V steps = hn::Ceil(steps_of(job, rays));  // the last one is looked at from its beginning
  V step = hn::Zero(d);
  M active = hn::Lt(step, steps);
  M found = hn::Lt(one, hn::Zero(d));
  V far_end = hn::Zero(d);
  while (!hn::AllFalse(d, active)) {
    const V t = hn::Min(hn::MulAdd(step, set(job.step_m), rays.begin), rays.end);
    const Point p = at(rays, t);
    const BrickPlace brick = brick_at(job, p);
    const M empty = hn::RebindMask(d, hn::Gt(brick.leap, hn::Zero(di)));
    const V reached = hn::Mul(hn::Sub(leap_end(rays, brick), rays.begin), set(1.0F / job.step_m));
    const V next = hn::IfThenElse(empty, hn::Max(hn::Add(step, one), hn::Ceil(reached)), hn::Add(step, one));
    ++counts.leaps;
    if (!hn::AllTrue(d, hn::Or(empty, hn::Not(active)))) {
      counts.samples += kLanes;
      const M hit = hn::And(hn::AndNot(empty, active), solid_at<kStored>(job, p));
      far_end = hn::IfThenElse(hit, t, far_end);
      found = hn::Or(found, hit);
      active = hn::AndNot(hit, active);
    }
    step = next;
    active = hn::And(active, hn::Lt(step, steps));
  }
  if (hn::AllFalse(d, found)) return;
  V low = hn::Max(hn::Sub(far_end, set(job.step_m)), rays.begin);
  V high = far_end;
  for (int i = 0; i < kRefinements; ++i) {
    const V middle = hn::Mul(set(0.5F), hn::Add(low, high));
    const M solid = solid_at<kStored>(job, at(rays, middle));
    high = hn::IfThenElse(solid, middle, high);
    low = hn::IfThenElse(solid, low, middle);
  }
  const VI packed = hn::BitCast(di, hn::Set(DU(), job.iso_colour));
  V red = byte_of(packed, 0);
  V green = byte_of(packed, 1);
  V blue = byte_of(packed, 2);
  if (job.light) {
    const Shade shade = shade_of(job, rays, gradient_at<kStored>(job, at(rays, high)), one);
    red = hn::MulAdd(red, shade.factor, shade.gloss);
    green = hn::MulAdd(green, shade.factor, shade.gloss);
    blue = hn::MulAdd(blue, shade.factor, shade.gloss);
  }
  sum.alpha = hn::IfThenElseZero(found, one);
  sum.red = hn::IfThenElseZero(found, red);
  sum.green = hn::IfThenElseZero(found, green);
  sum.blue = hn::IfThenElseZero(found, blue);
  sum.half_at = hn::IfThenElse(found, high, sum.half_at);
}

HWY_INLINE V affine(const AffineRow& row, V x, V y) {
  return hn::MulAdd(x, set(row.by_x), hn::MulAdd(y, set(row.by_y), set(row.at_0)));
}

// Keeps of [begin, end] what is within origin + t direction <= bound.
CELLMIRROR_LARGE_INLINE void keep_below(V origin, V direction, V bound, Rays& rays) {
  const D d;
  const V room = hn::Sub(bound, origin);
  const V t = hn::Div(room, direction);
  const M forward = hn::Gt(direction, hn::Zero(d));
  const M backward = hn::Lt(direction, hn::Zero(d));
  rays.end = hn::IfThenElse(forward, hn::Min(rays.end, t), rays.end);
  rays.begin = hn::IfThenElse(backward, hn::Max(rays.begin, t), rays.begin);
  const M beside = hn::AndNot(hn::Or(forward, backward), hn::Lt(room, hn::Zero(d)));
  rays.end = hn::IfThenElse(beside, set(-1.0F), rays.end);
}

HWY_INLINE V kept_from_zero(V value) {
  const V least = set(1e-12F);
  return hn::IfThenElse(hn::Lt(hn::Abs(value), least), hn::CopySign(least, value), value);
}

HWY_INLINE V row_at(const std::array<float, 4>& row, const Point& p, float w) {
  return hn::MulAdd(p.x, set(row[0]), hn::MulAdd(p.y, set(row[1]), hn::MulAdd(p.z, set(row[2]), set(w * row[3]))));
}

CELLMIRROR_LARGE_INLINE Rays rays_through(const KernelJob& job, V x, V y, V scene_depth) {
  const D d;
  Rays rays;
  rays.origin = {affine(job.origin[0], x, y), affine(job.origin[1], x, y), affine(job.origin[2], x, y)};
  Point to = {affine(job.direction[0], x, y), affine(job.direction[1], x, y), affine(job.direction[2], x, y)};
  const V mx = hn::Mul(to.x, set(1.0F / job.per_metre[0]));
  const V my = hn::Mul(to.y, set(1.0F / job.per_metre[1]));
  const V mz = hn::Mul(to.z, set(1.0F / job.per_metre[2]));
  const V scale = hn::Div(set(1.0F), hn::Sqrt(hn::MulAdd(mx, mx, hn::MulAdd(my, my, hn::Mul(mz, mz)))));
  rays.direction = {kept_from_zero(hn::Mul(to.x, scale)), kept_from_zero(hn::Mul(to.y, scale)),
                    kept_from_zero(hn::Mul(to.z, scale))};
  rays.inverse = {hn::Div(set(1.0F), rays.direction.x), hn::Div(set(1.0F), rays.direction.y),
                  hn::Div(set(1.0F), rays.direction.z)};
  rays.begin = hn::Zero(d);
  // z / w = 2 depth - 1 where it ends.
  const V ndc = hn::MulAdd(set(2.0F), scene_depth, set(-1.0F));
  const V z0 = row_at(job.clip_z, rays.origin, 1);
  const V w0 = row_at(job.clip_w, rays.origin, 1);
  const V z1 = row_at(job.clip_z, rays.direction, 0);
  const V w1 = row_at(job.clip_w, rays.direction, 0);
  rays.end = hn::Div(hn::MulSub(ndc, w0, z0), hn::NegMulAdd(ndc, w1, z1));
  const Point back{hn::Neg(rays.origin.x), hn::Neg(rays.origin.y), hn::Neg(rays.origin.z)};
  const V half = set(0.5F);
  keep_below(rays.origin.x, rays.direction.x, set(job.size[0] - 0.5F), rays);
  keep_below(rays.origin.y, rays.direction.y, set(job.size[1] - 0.5F), rays);
  keep_below(rays.origin.z, rays.direction.z, set(job.size[2] - 0.5F), rays);
  keep_below(back.x, hn::Neg(rays.direction.x), half, rays);
  keep_below(back.y, hn::Neg(rays.direction.y), half, rays);
  keep_below(back.z, hn::Neg(rays.direction.z), half, rays);
  for (std::size_t i = 0; i < job.plane_count; ++i) {
    const std::array<float, 4>& plane = job.planes[i];
    keep_below(row_at(plane, rays.origin, 0), row_at(plane, rays.direction, 0), set(plane[3]), rays);
  }
  return rays;
}

// Lanes are pixels of a packet: 4 x 4, 4 x 2, 4 x 1, 2 x 1 or 1.
struct Packet {
  int width;
  int height;
};

HWY_INLINE Packet packet_of(std::size_t lanes) {
  const int width = static_cast<int>(HWY_MIN(lanes, std::size_t{4}));
  return {width, static_cast<int>(lanes) / width};
}

HWY_INLINE std::uint8_t byte_from(float part) {
  return static_cast<std::uint8_t>(HWY_MIN(HWY_MAX(part, 0.0F), 1.0F) * 255.0F + 0.5F);
}

// Window depth at t of the ray, 1 where t is negative.
CELLMIRROR_LARGE_INLINE V window_depth(const KernelJob& job, const Rays& rays, V t) {
  const Point p = at(rays, t);
  const V z = row_at(job.clip_z, p, 1);
  const V w = row_at(job.clip_w, p, 1);
  const V depth = hn::MulAdd(set(0.5F), hn::Div(z, w), set(0.5F));
  return hn::IfThenElse(hn::Lt(t, hn::Zero(D())), set(1.0F), depth);
}

template <Stored kStored>
CELLMIRROR_LARGE_INLINE void cast_packet(const KernelJob& job, int x0, int y0, const Packet& packet,
                                         const PixelTile& tile, TileCounts& counts) {
  const D d;
  HWY_ALIGN float x[kLanes];
  HWY_ALIGN float y[kLanes];
  HWY_ALIGN float depth[kLanes];
  const int lanes = packet.width * packet.height;
  const auto pixel = [&](int lane) {
    const int px = HWY_MIN(x0 + lane % packet.width, tile.x + tile.width - 1);
    const int py = HWY_MIN(y0 + lane / packet.width, tile.y + tile.height - 1);
    return static_cast<std::size_t>(py) * static_cast<std::size_t>(job.width) + static_cast<std::size_t>(px);
  };
  for (int lane = 0; lane < lanes; ++lane) {
    x[lane] = static_cast<float>(x0 + lane % packet.width) + 0.5F;
    const int row = lane / packet.width;
    y[lane] = static_cast<float>(y0 + row) + 0.5F;
    depth[lane] = job.scene_depth == nullptr ? 1.0F : job.scene_depth[pixel(lane)];
  }
  const Rays rays = rays_through(job, hn::Load(d, x), hn::Load(d, y), hn::Load(d, depth));
  const V zero = hn::Zero(d);
  Sum sum{zero, zero, zero, zero, set(-1.0F)};
  if (!hn::AllFalse(d, hn::Lt(rays.begin, rays.end))) {
    if (job.isosurface)
      find_surface<kStored>(job, rays, sum, counts);
    else
      march<kStored>(job, rays, sum, counts);
  }
  HWY_ALIGN float red[kLanes];
  HWY_ALIGN float green[kLanes];
  HWY_ALIGN float blue[kLanes];
  HWY_ALIGN float alpha[kLanes];
  hn::Store(hn::Min(sum.red, sum.alpha), d, red);
  hn::Store(hn::Min(sum.green, sum.alpha), d, green);
  hn::Store(hn::Min(sum.blue, sum.alpha), d, blue);
  hn::Store(sum.alpha, d, alpha);
  hn::Store(window_depth(job, rays, sum.half_at), d, depth);
  for (int lane = 0; lane < lanes; ++lane) {
    if (x0 + lane % packet.width >= tile.x + tile.width || y0 + lane / packet.width >= tile.y + tile.height) continue;
    const std::size_t at_pixel = pixel(lane);
    std::uint8_t* const out = job.rgba + 4 * at_pixel;
    out[0] = byte_from(red[lane]);
    out[1] = byte_from(green[lane]);
    out[2] = byte_from(blue[lane]);
    out[3] = byte_from(alpha[lane]);
    job.seen_depth[at_pixel] = depth[lane];
  }
}

template <Stored kStored>
void cast_all(const KernelJob& job, const PixelTile& tile, TileCounts& counts) {
  const Packet packet = packet_of(hn::Lanes(D()));
  for (int y = tile.y; y < tile.y + tile.height; y += packet.height) {
    for (int x = tile.x; x < tile.x + tile.width; x += packet.width)
      cast_packet<kStored>(job, x, y, packet, tile, counts);
  }
}

TileCounts cast_one_tile(const KernelJob& job, const PixelTile& tile) {
  TileCounts counts;
  if (job.stored == Stored::u8)
    cast_all<Stored::u8>(job, tile, counts);
  else if (job.stored == Stored::i16)
    cast_all<Stored::i16>(job, tile, counts);
  else
    cast_all<Stored::u16>(job, tile, counts);
  return counts;
}

}  // namespace cellmirror::volume::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace cellmirror::volume {

HWY_EXPORT(cast_one_tile);

TileCounts cast_tile(const KernelJob& job, const PixelTile& tile) {
  return HWY_DYNAMIC_DISPATCH(cast_one_tile)(job, tile);
}

std::string_view simd_target() {
  const std::int64_t supported = hwy::SupportedTargets() & HWY_TARGETS;
  return hwy::TargetName(supported & -supported);  // the lowest bit is the best one
}

}  // namespace cellmirror::volume
#endif
