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

// Between two voxels of 8 bits, from a load of 4 bytes that does not reach beyond the volume.
HWY_INLINE V bytes_along_x(const KernelVoxels& voxels, VI offset, V fraction) {
  const DI di;
  const D d;
  const VI kept = hn::Min(offset, hn::Set(di, voxels.last_offset));  // counts from the middle slice
  const auto both =
      hn::BitCast(DU(), hn::GatherOffset(di, reinterpret_cast<const std::int32_t*>(voxels.middle_slice), kept)) >>
      hn::BitCast(DU(), hn::ShiftLeft<3>(hn::Sub(offset, kept)));
  const V low = hn::ConvertTo(d, hn::BitCast(di, hn::And(both, hn::Set(DU(), 0xFFU))));
  const V high = hn::ConvertTo(d, hn::BitCast(di, hn::And(hn::ShiftRight<8>(both), hn::Set(DU(), 0xFFU))));
  return hn::MulAdd(fraction, hn::Sub(high, low), low);
}

// The four pairs of voxels along x at the edges of a cell; `slice` and `next`: in the next slice.
struct CellEdges {
  VI here, row, slice, next;
};

#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
// Single loads instead of gathers, each broadcast into its lane: on AMD's Zen 4 four gathers of 16 lanes take longer,
// and their many operations keep the loads of several samples from overlapping. Insertions and shuffles in place of
// masked broadcasts would compete with arithmetic for execution units.
HWY_INLINE __m128i pair_at(const std::byte* at) {
  std::int32_t pair = 0;
  std::memcpy(&pair, at, sizeof(pair));
  return _mm_cvtsi32_si128(pair);
}

HWY_INLINE VI pairs_at(const std::byte* base, const std::int32_t* offsets) {
  const auto four = [&](int k) {
    __m128i pairs = _mm_broadcastd_epi32(pair_at(base + offsets[k]));
    pairs = _mm_mask_broadcastd_epi32(pairs, 2, pair_at(base + offsets[k + 1]));
    pairs = _mm_mask_broadcastd_epi32(pairs, 4, pair_at(base + offsets[k + 2]));
    return _mm_mask_broadcastd_epi32(pairs, 8, pair_at(base + offsets[k + 3]));
  };
  const __m256i low = _mm256_inserti128_si256(_mm256_castsi128_si256(four(0)), four(4), 1);
  const __m256i high = _mm256_inserti128_si256(_mm256_castsi128_si256(four(8)), four(12), 1);
  return VI{_mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1)};
}

HWY_INLINE CellEdges edges_at(const KernelVoxels& voxels, VI offset) {
  HWY_ALIGN std::int32_t offsets[kLanes];
  hn::Store(offset, DI(), offsets);
  const std::byte* const slice = voxels.middle_slice + static_cast<std::ptrdiff_t>(voxels.slice_bytes);
  const std::ptrdiff_t row = voxels.row_bytes;
  return {pairs_at(voxels.middle_slice, offsets), pairs_at(voxels.middle_slice + row, offsets),
          pairs_at(slice, offsets), pairs_at(slice + row, offsets)};
}

// Of two voxels of 16 bits side by side along x, the first in the lower half of a lane, by one multiplication of pairs:
// the second's share in parts of 2^14. Values with a sign; what has none is moved below 0 by half its range.
constexpr float kPairUnit = 1.0F / 16384;
template <Stored kStored>
constexpr float kPairOffset = kStored == Stored::u16 ? 32768.0F : 0.0F;

HWY_INLINE VI pair_weights(V fraction) {
  const VI second = hn::NearestInt(hn::Mul(fraction, set(1 / kPairUnit)));
  return hn::Add(hn::Sub(hn::ShiftLeft<16>(second), second), hn::Set(DI(), 16384));
}

template <Stored kStored>
HWY_INLINE V along_x(VI both, VI weights) {
  if constexpr (kStored == Stored::u16) both = hn::Xor(both, hn::Set(DI(), static_cast<std::int32_t>(0x8000'8000U)));
  return hn::ConvertTo(D(), VI{_mm512_madd_epi16(both.raw, weights.raw)});
}
#else
HWY_INLINE CellEdges edges_at(const KernelVoxels& voxels, VI offset) {
  const auto pairs = [&](std::ptrdiff_t beyond) {
    return hn::GatherOffset(DI(), reinterpret_cast<const std::int32_t*>(voxels.middle_slice + beyond), offset);
  };
  const std::ptrdiff_t row = voxels.row_bytes;
  const std::ptrdiff_t slice = voxels.slice_bytes;
  return {pairs(0), pairs(row), pairs(slice), pairs(slice + row)};
}

constexpr float kPairUnit = 1;
template <Stored kStored>
constexpr float kPairOffset = 0;

HWY_INLINE V pair_weights(V fraction) { return fraction; }

// Between two voxels of 16 bits side by side along x, the first in the lower half of a lane.
template <Stored kStored>
HWY_INLINE V along_x(VI both, V fraction) {
  const DI di;
  const D d;
  V low;
  V high;
  if constexpr (kStored == Stored::i16) {
    low = hn::ConvertTo(d, hn::ShiftRight<16>(hn::ShiftLeft<16>(both)));
    high = hn::ConvertTo(d, hn::ShiftRight<16>(both));
  } else {
    low = hn::ConvertTo(d, hn::And(both, hn::Set(di, 0xFFFF)));
    high = hn::ConvertTo(d, hn::BitCast(di, hn::ShiftRight<16>(hn::BitCast(DU(), both))));
  }
  return hn::MulAdd(fraction, hn::Sub(high, low), low);
}
#endif

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
  V a;
  V b;
  V c;
  V e;
  if constexpr (kStored == Stored::u8) {
    const VI slice = hn::Set(di, voxels.slice_bytes);
    const VI next_row = hn::Add(offset, hn::Set(di, voxels.row_bytes));
    a = bytes_along_x(voxels, offset, fx);
    b = bytes_along_x(voxels, next_row, fx);
    c = bytes_along_x(voxels, hn::Add(offset, slice), fx);
    e = bytes_along_x(voxels, hn::Add(next_row, slice), fx);
  } else {
    const CellEdges edges = edges_at(voxels, offset);
    const auto weights = pair_weights(fx);
    a = along_x<kStored>(edges.here, weights);
    b = along_x<kStored>(edges.row, weights);
    c = along_x<kStored>(edges.slice, weights);
    e = along_x<kStored>(edges.next, weights);
  }
  const V front = hn::MulAdd(fy, hn::Sub(b, a), a);
  const V back = hn::MulAdd(fy, hn::Sub(e, c), c);
  const V value = hn::MulAdd(fz, hn::Sub(back, front), front);
  if constexpr (kStored == Stored::u8)
    return value;
  else
    return hn::MulAdd(value, set(kPairUnit), set(kPairOffset<kStored>));
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
