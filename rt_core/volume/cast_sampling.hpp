// Values of a volume and their gradients at 16 points at once. Part of cast_kernel.cpp: compiled once for each
// instruction set, so included once by each of its passes.
#include <hwy/highway.h>

#if defined(CELLMIRROR_CAST_SAMPLING) == defined(HWY_TARGET_TOGGLE)
#ifdef CELLMIRROR_CAST_SAMPLING
#undef CELLMIRROR_CAST_SAMPLING
#else
#define CELLMIRROR_CAST_SAMPLING
#endif

#include "rt_core/volume/cast_kernel.hpp"

HWY_BEFORE_NAMESPACE();
namespace cellmirror::volume::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kLanes = 16;
using D = hn::CappedTag<float, kLanes>;
using DI = hn::RebindToSigned<D>;
using DU = hn::RebindToUnsigned<D>;
using V = hn::Vec<D>;
using VI = hn::Vec<DI>;
using M = hn::Mask<D>;

constexpr int kBrickShift = 3;
constexpr int kRefinements = 5;       // halvings of the step in which an isosurface was passed
constexpr float kWorthLight = 0.01F;  // opacity that a sample adds from which its shading is computed
constexpr float kAmbient = 0.30F;
constexpr float kDiffuse = 0.70F;
constexpr float kSpecular = 0.18F;
constexpr int kChecked = 4;  // samples between looks at the bricks

HWY_INLINE V set(float value) { return hn::Set(D(), value); }

struct Point {
  V x, y, z;
};

HWY_INLINE V kept_within(V value, float largest) { return hn::Min(hn::Max(value, hn::Zero(D())), set(largest)); }

struct Rays {
  Point origin;     // index space
  Point direction;  // index units a metre
  Point inverse;    // 1 / direction
  V begin;          // m
  V end;
};

HWY_INLINE Point at(const Rays& rays, V t) {
  return {hn::MulAdd(t, rays.direction.x, rays.origin.x), hn::MulAdd(t, rays.direction.y, rays.origin.y),
          hn::MulAdd(t, rays.direction.z, rays.origin.z)};
}

// Two voxels side by side along x, from one load of 4 bytes.
template <Stored kStored>
HWY_INLINE V along_x(const KernelVoxels& voxels, const std::byte* base, VI offset, V fraction) {
  const DI di;
  const D d;
  const auto* const from = reinterpret_cast<const std::int32_t*>(base);
  V low;
  V high;
  if constexpr (kStored == Stored::i16) {
    const VI both = hn::GatherOffset(di, from, offset);
    low = hn::ConvertTo(d, hn::ShiftRight<16>(hn::ShiftLeft<16>(both)));
    high = hn::ConvertTo(d, hn::ShiftRight<16>(both));
  } else if constexpr (kStored == Stored::u16) {
    const VI both = hn::GatherOffset(di, from, offset);
    low = hn::ConvertTo(d, hn::And(both, hn::Set(di, 0xFFFF)));
    high = hn::ConvertTo(d, hn::BitCast(di, hn::ShiftRight<16>(hn::BitCast(DU(), both))));
  } else {
    const VI kept = hn::Min(offset, hn::Set(di, voxels.last_offset));
    const auto both = hn::BitCast(DU(), hn::GatherOffset(di, from, kept)) >>
                      hn::BitCast(DU(), hn::ShiftLeft<3>(hn::Sub(offset, kept)));
    low = hn::ConvertTo(d, hn::BitCast(di, hn::And(both, hn::Set(DU(), 0xFFU))));
    high = hn::ConvertTo(d, hn::BitCast(di, hn::And(hn::ShiftRight<8>(both), hn::Set(DU(), 0xFFU))));
  }
  return hn::MulAdd(fraction, hn::Sub(high, low), low);
}

template <Stored kStored>
CELLMIRROR_LARGE_INLINE V value_in(const KernelVoxels& voxels, const Point& p) {
  const DI di;
  const D d;
  const V x = kept_within(p.x, voxels.largest[0]);
  const V y = kept_within(p.y, voxels.largest[1]);
  const V z = kept_within(p.z, voxels.largest[2]);
  const VI i = hn::ConvertTo(di, x);
  const VI j = hn::ConvertTo(di, y);
  const VI k = hn::ConvertTo(di, z);
  const V fx = hn::Sub(x, hn::ConvertTo(d, i));
  const V fy = hn::Sub(y, hn::ConvertTo(d, j));
  const V fz = hn::Sub(z, hn::ConvertTo(d, k));
  const VI in_row = kStored == Stored::u8 ? i : hn::Add(i, i);
  const VI offset = hn::Add(hn::Add(in_row, hn::Mul(j, hn::Set(di, voxels.row_bytes))),
                            hn::Mul(hn::Sub(k, hn::Set(di, voxels.middle)), hn::Set(di, voxels.slice_bytes)));
  const std::byte* const base = voxels.middle_slice;
  V a;
  V b;
  V c;
  V e;
  if constexpr (kStored == Stored::u8) {  // last_offset counts from the middle slice
    a = along_x<kStored>(voxels, base, offset, fx);
    const VI next_row = hn::Add(offset, hn::Set(di, voxels.row_bytes));
    b = along_x<kStored>(voxels, base, next_row, fx);
    c = along_x<kStored>(voxels, base, hn::Add(offset, hn::Set(di, voxels.slice_bytes)), fx);
    e = along_x<kStored>(voxels, base, hn::Add(next_row, hn::Set(di, voxels.slice_bytes)), fx);
  } else {
    a = along_x<kStored>(voxels, base, offset, fx);
    b = along_x<kStored>(voxels, base + voxels.row_bytes, offset, fx);
    c = along_x<kStored>(voxels, base + voxels.slice_bytes, offset, fx);
    e = along_x<kStored>(voxels, base + voxels.slice_bytes + voxels.row_bytes, offset, fx);
  }
  const V front = hn::MulAdd(fy, hn::Sub(b, a), a);
  const V back = hn::MulAdd(fy, hn::Sub(e, c), c);
  return hn::MulAdd(fz, hn::Sub(back, front), front);
}

template <Stored kStored>
HWY_INLINE V value_at(const KernelJob& job, const Point& p) {
  return value_in<kStored>(job.fine, p);
}

template <Stored kStored>
HWY_INLINE V coarse_value_at(const KernelJob& job, const Point& p) {
  const V half = set(0.5F);
  const V shift = set(-0.25F);
  return value_in<kStored>(job.coarse,
                           {hn::MulAdd(p.x, half, shift), hn::MulAdd(p.y, half, shift), hn::MulAdd(p.z, half, shift)});
}

// By differences between the corners of a tetrahedron around the point; stored units a metre, in V.
template <Stored kStored>
CELLMIRROR_LARGE_INLINE Point gradient_at(const KernelJob& job, const Point& p) {
  const V half = set(0.5F);
  const Point above{hn::Add(p.x, half), hn::Add(p.y, half), hn::Add(p.z, half)};
  const Point below{hn::Sub(p.x, half), hn::Sub(p.y, half), hn::Sub(p.z, half)};
  const V ppp = value_at<kStored>(job, above);
  const V pnn = value_at<kStored>(job, {above.x, below.y, below.z});
  const V npn = value_at<kStored>(job, {below.x, above.y, below.z});
  const V nnp = value_at<kStored>(job, {below.x, below.y, above.z});
  const V a = hn::Sub(ppp, pnn);
  const V b = hn::Sub(npn, nnp);
  const V x = hn::Sub(hn::Add(ppp, pnn), hn::Add(npn, nnp));
  // Each is twice the difference over one voxel.
  return {hn::Mul(x, set(0.5F * job.per_metre[0])), hn::Mul(hn::Add(a, b), set(0.5F * job.per_metre[1])),
          hn::Mul(hn::Sub(a, b), set(0.5F * job.per_metre[2]))};
}

}  // namespace cellmirror::volume::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
