#include "rt_core/tissue/body/element_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rt_core/tissue/body/element_kernel.cpp"
// Compiles this file once for each instruction set.
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace cellmirror::tissue::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr float kLeastJ = 0.1F;

// 1 / cube root of values in [0.1, 10], Newton's method from a value whose logarithm is right to some per cent.
template <class D, class V>
HWY_INLINE V inverse_cube_root(D d, V x) {
  const hn::Rebind<std::int32_t, D> di;
  // As a float, the bits of x are about 2^23 (log2 x + 127); those of x^(-1/3) are 4/3 * 127 * 2^23 less a third.
  const auto bits = hn::ConvertTo(d, hn::BitCast(di, x));
  const auto guess = hn::ConvertTo(di, hn::NegMulAdd(bits, hn::Set(d, 1.0F / 3.0F), hn::Set(d, 1.4206087e9F)));
  V y = hn::BitCast(d, guess);
  for (int i = 0; i < 3; ++i) {
    const V cube = hn::Mul(hn::Mul(y, y), hn::Mul(y, x));
    y = hn::Mul(y, hn::NegMulAdd(cube, hn::Set(d, 1.0F / 3.0F), hn::Set(d, 4.0F / 3.0F)));
  }
  return y;
}

template <class D>
struct Matrix {
  hn::Vec<D> m[3][3];
};

template <class D>
HWY_INLINE Matrix<D> load(D d, const float* HWY_RESTRICT from) {
  Matrix<D> a;
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) a.m[r][c] = hn::Load(d, from + (3 * r + c) * kLanes);
  }
  return a;
}

template <class D>
HWY_INLINE Matrix<D> product(const Matrix<D>& a, const Matrix<D>& b) {
  Matrix<D> p;
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) {
      p.m[r][c] = hn::MulAdd(a.m[r][0], b.m[0][c], hn::MulAdd(a.m[r][1], b.m[1][c], hn::Mul(a.m[r][2], b.m[2][c])));
    }
  }
  return p;
}

template <class D>
HWY_INLINE Matrix<D> cofactors(const Matrix<D>& a) {
  Matrix<D> c;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t i1 = (i + 1) % 3;
    const std::size_t i2 = (i + 2) % 3;
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t j1 = (j + 1) % 3;
      const std::size_t j2 = (j + 2) % 3;
      c.m[i][j] = hn::MulSub(a.m[i1][j1], a.m[i2][j2], hn::Mul(a.m[i1][j2], a.m[i2][j1]));
    }
  }
  return c;
}

// Green's strain less its value in the step before, which it replaces in `last`: xx, yy, zz, xy, xz, yz.
template <class D>
HWY_INLINE void strain_change(D d, const Matrix<D>& f, float* HWY_RESTRICT last, hn::Vec<D>* change) {
  constexpr std::size_t kRow[6] = {0, 1, 2, 0, 0, 1};
  constexpr std::size_t kColumn[6] = {0, 1, 2, 1, 2, 2};
  const auto half = hn::Set(d, 0.5F);
  for (std::size_t k = 0; k < 6; ++k) {
    const std::size_t i = kRow[k];
    const std::size_t j = kColumn[k];
    const auto c = hn::MulAdd(f.m[0][i], f.m[0][j], hn::MulAdd(f.m[1][i], f.m[1][j], hn::Mul(f.m[2][i], f.m[2][j])));
    const auto strain = hn::Mul(half, k < 3 ? hn::Sub(c, hn::Set(d, 1.0F)) : c);
    float* const at = last + k * kLanes;
    change[k] = hn::Sub(strain, hn::Load(d, at));
    hn::Store(strain, d, at);
  }
}

struct LaneResult {
  float largest;
  float largest_areas;
  std::uint32_t inverted;
  float energy;
};

template <class D>
HWY_INLINE LaneResult lanes(D d, const float* HWY_RESTRICT material, const float* HWY_RESTRICT edges,
                            float* HWY_RESTRICT last, float* HWY_RESTRICT forces, float* HWY_RESTRICT strain_out,
                            float* HWY_RESTRICT areas_out) {
  using V = hn::Vec<D>;
  const Matrix<D> b = load(d, material);
  const V mu = hn::Load(d, material + 9 * kLanes);
  const V bulk = hn::Load(d, material + 10 * kLanes);
  const V viscous_mu = hn::Load(d, material + 11 * kLanes);
  const V viscous_lambda = hn::Load(d, material + 12 * kLanes);
  const Matrix<D> f = product<D>(load(d, edges), b);
  const Matrix<D> c = cofactors<D>(f);
  const V j = hn::MulAdd(f.m[0][0], c.m[0][0], hn::MulAdd(f.m[0][1], c.m[0][1], hn::Mul(f.m[0][2], c.m[0][2])));
  V i1 = hn::Zero(d);
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t k = 0; k < 3; ++k) i1 = hn::MulAdd(f.m[r][k], f.m[r][k], i1);
  }
  const V least = hn::Set(d, kLeastJ);
  const auto ordinary = hn::Gt(j, least);
  const V j_kept = hn::Max(j, least);
  const V root = inverse_cube_root(d, j_kept);
  const V scaled_mu = hn::Mul(mu, hn::Mul(root, root));
  // P V = mu V J^(-2/3) (F - I1 / (3 J) cof F) + K V (J - 1) cof F + viscous part
  const V isochoric = hn::IfThenElseZero(ordinary, hn::Div(hn::Mul(scaled_mu, i1), hn::Mul(hn::Set(d, 3.0F), j_kept)));
  const V on_cofactors = hn::Sub(hn::Mul(bulk, hn::Sub(j, hn::Set(d, 1.0F))), isochoric);

  V change[6];
  strain_change(d, f, last, change);
  const V volumetric = hn::Mul(viscous_lambda, hn::Add(change[0], hn::Add(change[1], change[2])));
  V s[3][3];
  constexpr std::size_t kAt[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t k = 0; k < 3; ++k) {
      s[r][k] = hn::Mul(viscous_mu, change[kAt[r][k]]);
      if (r == k) s[r][k] = hn::Add(s[r][k], volumetric);
    }
  }
  Matrix<D> p;
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t k = 0; k < 3; ++k) {
      V sum = hn::MulAdd(scaled_mu, f.m[r][k], hn::Mul(on_cofactors, c.m[r][k]));
      for (std::size_t l = 0; l < 3; ++l) sum = hn::MulAdd(f.m[r][l], s[l][k], sum);
      p.m[r][k] = sum;
    }
  }
  // Force on node n (1 to 3), component r: -(P V B^T)(r, n - 1).
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t n = 0; n < 3; ++n) {
      const V sum = hn::MulAdd(p.m[r][0], b.m[n][0], hn::MulAdd(p.m[r][1], b.m[n][1], hn::Mul(p.m[r][2], b.m[n][2])));
      hn::Store(hn::Neg(sum), d, forces + (3 * r + n) * kLanes);
    }
  }
  const V strain = hn::MulSub(i1, hn::Mul(root, root), hn::Set(d, 3.0F));
  hn::Store(strain, d, strain_out);
  V areas = hn::Zero(d);
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t k = r; k < 3; ++k) {
      const V product =
          hn::MulAdd(c.m[0][r], c.m[0][k], hn::MulAdd(c.m[1][r], c.m[1][k], hn::Mul(c.m[2][r], c.m[2][k])));
      areas = hn::MulAdd(r == k ? product : hn::Add(product, product), product, areas);
    }
  }
  // Lanes behind the last element have F = 0.
  const auto squeezed = hn::And(hn::Lt(j, hn::Set(d, 0.75F)), hn::Gt(i1, hn::Zero(d)));
  areas = hn::IfThenElse(squeezed, hn::Max(areas, hn::Set(d, kSqueezedAreas)), areas);
  hn::Store(areas, d, areas_out);
  const V compression = hn::Sub(j, hn::Set(d, 1.0F));
  const V twice_energy = hn::MulAdd(mu, strain, hn::Mul(hn::Mul(bulk, compression), compression));
  return {hn::GetLane(hn::MaxOfLanes(d, strain)), hn::GetLane(hn::MaxOfLanes(d, areas)),
          static_cast<std::uint32_t>(hn::CountTrue(d, hn::Lt(j, hn::Zero(d)))),
          0.5F * hn::GetLane(hn::SumOfLanes(d, twice_energy))};
}

KernelSums element_forces(ElementBlocks& blocks) {
  const hn::CappedTag<float, kLanes> d;
  const std::size_t step = hn::Lanes(d);
  KernelSums sums;
  for (std::size_t block = 0; block < blocks.blocks(); ++block) {
    for (std::size_t lane = 0; lane < kLanes; lane += step) {
      const LaneResult result =
          lanes(d, blocks.material[block * ElementBlocks::kMaterialValues].lane.data() + lane,
                blocks.edges[block * 9].lane.data() + lane, blocks.last_strain[block * 6].lane.data() + lane,
                blocks.forces[block * 9].lane.data() + lane, blocks.strain[block].lane.data() + lane,
                blocks.areas[block].lane.data() + lane);
      sums.largest_strain = HWY_MAX(sums.largest_strain, result.largest);
      sums.largest_areas = HWY_MAX(sums.largest_areas, result.largest_areas);
      sums.inverted += result.inverted;
      sums.energy += static_cast<double>(result.energy);
    }
  }
  return sums;
}

}  // namespace cellmirror::tissue::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace cellmirror::tissue {

HWY_EXPORT(element_forces);

void ElementBlocks::resize(std::size_t elements) {
  count = elements;
  material.resize(blocks() * kMaterialValues);
  last_strain.resize(blocks() * 6);
  edges.resize(blocks() * 9);
  forces.resize(blocks() * 9);
  strain.resize(blocks());
  areas.resize(blocks());
}

KernelSums compute_element_forces(ElementBlocks& blocks) { return HWY_DYNAMIC_DISPATCH(element_forces)(blocks); }

namespace {

std::int64_t best_target() {
  const std::int64_t supported = hwy::SupportedTargets() & HWY_TARGETS;
  return supported & -supported;  // the lowest bit is the best one
}

}  // namespace

std::string_view simd_target() { return hwy::TargetName(best_target()); }

bool force_simd_target(std::string_view name) {
  hwy::SetSupportedTargetsForTest(0);
  const std::int64_t supported = hwy::SupportedTargets() & HWY_TARGETS;
  bool found = name.empty();
  for (std::int64_t rest = supported; !name.empty() && rest != 0; rest &= rest - 1) {
    const std::int64_t target = rest & -rest;
    if (hwy::TargetName(target) == name) {
      hwy::SetSupportedTargetsForTest(target);
      found = true;
      break;
    }
  }
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  return found;
}

}  // namespace cellmirror::tissue
#endif
