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
// Single loads instead of gathers: on AMD's Zen 4 four gathers of 16 lanes take 20 ns, these 14 ns, and so few
// operations that the loads of several samples overlap.
HWY_INLINE __m128i edges_of_cell(const std::byte* at, std::ptrdiff_t row, std::ptrdiff_t slice) {
  std::int32_t pair[4];
  std::memcpy(&pair[0], at, sizeof(pair[0]));
  std::memcpy(&pair[1], at + row, sizeof(pair[1]));
  std::memcpy(&pair[2], at + slice, sizeof(pair[2]));
  std::memcpy(&pair[3], at + slice + row, sizeof(pair[3]));
  const __m128i two = _mm_insert_epi32(_mm_cvtsi32_si128(pair[0]), pair[1], 1);
  return _mm_insert_epi32(_mm_insert_epi32(two, pair[2], 2), pair[3], 3);
}

HWY_INLINE CellEdges edges_at(const KernelVoxels& voxels, VI offset) {
  HWY_ALIGN std::int32_t offsets[kLanes];
  hn::Store(offset, DI(), offsets);
  const auto edges = [&](int lane) {
    return edges_of_cell(voxels.middle_slice + offsets[lane], voxels.row_bytes, voxels.slice_bytes);
  };
  // Lanes k, k + 4, k + 8 and k + 12, then turned so that each vector has one edge of all lanes.
  const auto four = [&](int k) {
    const __m256i low = _mm256_inserti128_si256(_mm256_castsi128_si256(edges(k)), edges(k + 4), 1);
    const __m256i high = _mm256_inserti128_si256(_mm256_castsi128_si256(edges(k + 8)), edges(k + 12), 1);
    return _mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1);
  };
  const __m512i zero = four(0);
  const __m512i one = four(1);
  const __m512i two = four(2);
  const __m512i three = four(3);
  const __m512i low_01 = _mm512_unpacklo_epi32(zero, one);
  const __m512i high_01 = _mm512_unpackhi_epi32(zero, one);
  const __m512i low_23 = _mm512_unpacklo_epi32(two, three);
  const __m512i high_23 = _mm512_unpackhi_epi32(two, three);
  return {VI{_mm512_unpacklo_epi64(low_01, low_23)}, VI{_mm512_unpackhi_epi64(low_01, low_23)},
          VI{_mm512_unpacklo_epi64(high_01, high_23)}, VI{_mm512_unpackhi_epi64(high_01, high_23)}};
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
    a = along_x<kStored>(edges.here, fx);
    b = along_x<kStored>(edges.row, fx);
    c = along_x<kStored>(edges.slice, fx);
    e = along_x<kStored>(edges.next, fx);
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
