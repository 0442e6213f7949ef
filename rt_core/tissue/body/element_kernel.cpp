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

// The largest eigenvalue of a symmetric matrix without negative ones, over a third of its trace I1, from above.
// q = I2 / I1^2, r = I3 / I1^3 with its second and third invariant. With m = I1 / 3 and m e the spread of the
// eigenvalues it is m (1 + e t), where t, between 1 and 2, is the largest root of t^3 - 3 t = 2 c: Newton's method from
// 2 comes down to it.
template <class D, class V>
HWY_INLINE V largest_eigenvalue(D d, V q, V r) {
  constexpr float kRounding = 1e-6F;
  const V squared =
      hn::Add(hn::Max(hn::NegMulAdd(hn::Set(d, 3.0F), q, hn::Set(d, 1.0F)), hn::Zero(d)), hn::Set(d, kRounding));
  const V e = hn::Sqrt(squared);
  const V twice_c =
      hn::Div(hn::MulAdd(hn::Set(d, 27.0F), r, hn::NegMulAdd(hn::Set(d, 9.0F), q, hn::Set(d, 2.0F + kRounding))),
              hn::Mul(e, squared));
  const V kept = hn::Min(hn::Max(twice_c, hn::Set(d, -2.0F)), hn::Set(d, 2.0F));
  V t = hn::MulAdd(kept, hn::Set(d, 1.0F / 9.0F), hn::Set(d, 16.0F / 9.0F));  // the first step
  for (int i = 0; i < 2; ++i) {
    const V tt = hn::Mul(t, t);
    const V slope = hn::MulSub(hn::Set(d, 3.0F), tt, hn::Set(d, 3.0F));
    t = hn::Div(hn::MulAdd(hn::Mul(hn::Set(d, 2.0F), tt), t, kept), slope);
  }
  return hn::MulAdd(e, t, hn::Set(d, 1.0F));
}

// What decides how stiff a deformed element is.
template <class D>
struct Stretch {
  hn::Vec<D> i1;        // of F^T F
  hn::Vec<D> i2;        // |cof F|^2
  hn::Vec<D> j;         // volume
  hn::Vec<D> shear;     // mu V J^(-2/3)
  hn::Vec<D> across;    // stiffness against a change of volume, times V
  hn::Vec<D> pressure;  // times V
  hn::Vec<D> elastic_factor;
  hn::Vec<D> viscous_factor;
};

// The largest eigenvalue of the second derivative of the energy for waves (acoustic tensor), term by term, plus the
// viscosity; F takes part on both sides of the latter's moduli. `length`: largest stretch; `longest`: its square;
// `widest`: largest stretch of an area, squared.
template <class D, class V>
HWY_INLINE V load_of(const Stretch<D>& s, V length, V longest, V widest) {
  const V elastic = hn::MulAdd(s.across, widest, hn::MulAdd(hn::Abs(s.pressure), length, s.shear));
  return hn::MulAdd(s.elastic_factor, elastic, hn::Mul(s.viscous_factor, longest));
}

// Of all lanes: first with bounds of the eigenvalues, then, where these ask for more mass, with the eigenvalues.
template <class D>
HWY_INLINE hn::Vec<D> load_from_above(D d, const Stretch<D>& s) {
  using V = hn::Vec<D>;
  const V third = hn::Set(d, 1.0F / 3.0F);
  const V two = hn::Set(d, 2.0F);
  const V three = hn::Set(d, 3.0F);
  const V zero = hn::Zero(d);
  const V spread = hn::Sqrt(hn::Max(hn::MulSub(s.i1, s.i1, hn::Mul(three, s.i2)), zero));
  const V i3 = hn::Mul(s.j, s.j);
  const V spread_of_areas = hn::Sqrt(hn::Max(hn::MulSub(s.i2, s.i2, hn::Mul(three, hn::Mul(s.i1, i3))), zero));
  const V most_long = hn::Mul(third, hn::MulAdd(two, spread, s.i1));
  const V most_wide = hn::Mul(third, hn::MulAdd(two, spread_of_areas, s.i2));
  // The mean of 1 and a number is more than its root.
  const V mean = hn::Mul(hn::Set(d, 0.5F), hn::Add(most_long, hn::Set(d, 1.0F)));
  const V bound = load_of(s, mean, most_long, most_wide);
  const V most = hn::Set(d, kMostLoad);
  if (hn::AllFalse(d, hn::Gt(bound, most))) return bound;
  const V tiny = hn::Set(d, 1e-12F);
  const V by_i1 = hn::Div(hn::Set(d, 1.0F), hn::Max(s.i1, tiny));
  const V by_i2 = hn::Div(hn::Set(d, 1.0F), hn::Max(s.i2, tiny));
  const V slimness = hn::Mul(s.i2, hn::Mul(by_i1, by_i1));
  const V volume = hn::Mul(hn::Mul(s.j, by_i1), hn::Mul(s.j, hn::Mul(by_i1, by_i1)));
  const V flatness = hn::Mul(s.j, by_i2);
  const V flatness2 = hn::Mul(flatness, flatness);
  const V longest = hn::Mul(hn::Mul(third, s.i1), largest_eigenvalue(d, slimness, volume));
  const V widest = hn::Mul(hn::Mul(third, s.i2),
                           largest_eigenvalue(d, hn::Mul(s.i1, flatness2), hn::Mul(flatness2, hn::Mul(i3, by_i2))));
  // Not finite only where positions are not.
  return hn::Min(hn::Min(bound, load_of(s, hn::Sqrt(longest), longest, widest)), hn::Set(d, 1e12F));
}

template <class D>
struct LaneSums {
  hn::Vec<D> strain;
  hn::Vec<D> load;
  hn::Vec<D> twice_energy;
  std::size_t inverted;
};

template <class D>
HWY_INLINE void lanes(D d, const float* HWY_RESTRICT material, const float* HWY_RESTRICT edges,
                      float* HWY_RESTRICT last, float* HWY_RESTRICT forces, float* HWY_RESTRICT strain_out,
                      float* HWY_RESTRICT load_out, LaneSums<D>& sums) {
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
  V i2 = hn::Zero(d);
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t k = 0; k < 3; ++k) {
      i1 = hn::MulAdd(f.m[r][k], f.m[r][k], i1);
      i2 = hn::MulAdd(c.m[r][k], c.m[r][k], i2);
    }
  }
  const V one = hn::Set(d, 1.0F);
  const V least = hn::Set(d, kLeastJ);
  const auto ordinary = hn::Gt(j, least);
  const V root = inverse_cube_root(d, hn::Max(j, least));
  const V root2 = hn::Mul(root, root);
  const V by_j = hn::Mul(root2, root);
  const V scaled_mu = hn::Mul(mu, root2);
  // P V = mu V J^(-2/3) (F - I1 / (3 J) cof F) + K V (J - 1) cof F + viscous part
  const V isochoric =
      hn::IfThenElseZero(ordinary, hn::Mul(hn::Mul(scaled_mu, i1), hn::Mul(hn::Set(d, 1.0F / 3.0F), by_j)));
  const V compression = hn::Sub(j, one);
  const V on_cofactors = hn::MulSub(bulk, compression, isochoric);

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
  const V strain = hn::MulSub(i1, root2, hn::Set(d, 3.0F));
  hn::Store(strain, d, strain_out);
  const V across = hn::MulAdd(hn::Mul(hn::Set(d, 5.0F / 3.0F), isochoric), by_j, bulk);
  const V load =
      load_from_above(d, Stretch<D>{i1, i2, j, scaled_mu, across, on_cofactors, hn::Load(d, material + 13 * kLanes),
                                    hn::Load(d, material + 14 * kLanes)});
  hn::Store(load, d, load_out);
  sums.strain = hn::Max(sums.strain, strain);
  sums.load = hn::Max(sums.load, load);
  sums.twice_energy =
      hn::Add(sums.twice_energy, hn::MulAdd(mu, strain, hn::Mul(hn::Mul(bulk, compression), compression)));
  sums.inverted += hn::CountTrue(d, hn::Lt(j, hn::Zero(d)));
}

// gather(): edges of kLanes elements, x of nodes 1, 2, 3 less x of node 0, by component and then node. scatter(): adds
// forces, laid out as edges, to f; in doubles, so that those within a body add up to zero.
#if HWY_TARGET == HWY_SCALAR

HWY_INLINE void gather(const std::array<std::uint32_t, 4>* HWY_RESTRICT nodes, const NodeVector* HWY_RESTRICT x,
                       float* HWY_RESTRICT edges) {
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const std::array<std::uint32_t, 4>& of = nodes[lane];
    for (std::size_t n = 0; n < 3; ++n) {
      for (std::size_t r = 0; r < 3; ++r) {
        edges[(3 * r + n) * kLanes + lane] = static_cast<float>(x[of[n + 1]].xyz0[r] - x[of[0]].xyz0[r]);
      }
    }
  }
}

HWY_INLINE void scatter(const std::array<std::uint32_t, 4>* HWY_RESTRICT nodes, const float* HWY_RESTRICT forces,
                        NodeVector* HWY_RESTRICT f) {
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const std::array<std::uint32_t, 4>& of = nodes[lane];
    for (std::size_t r = 0; r < 3; ++r) {
      double sum = 0;
      for (std::size_t n = 0; n < 3; ++n) {
        const double force = static_cast<double>(forces[(3 * r + n) * kLanes + lane]);
        f[of[n + 1]].xyz0[r] += force;
        sum += force;
      }
      f[of[0]].xyz0[r] -= sum;
    }
  }
}

#else

// Four floats and four doubles, in one register or two.
using Floats = hn::FixedTag<float, 4>;
using Doubles = hn::CappedTag<double, 4>;

template <class DD>
HWY_INLINE hn::Vec<Floats> difference(DD dd, const NodeVector& a, const NodeVector& b) {
  const auto part = [&](std::size_t at) HWY_ATTR {
    return hn::Sub(hn::Load(dd, a.xyz0.data() + at), hn::Load(dd, b.xyz0.data() + at));
  };
  if constexpr (hn::MaxLanes(DD()) == 4) {
    return hn::DemoteTo(Floats(), part(0));
  } else {
    const hn::Half<Floats> half;
    return hn::Combine(Floats(), hn::DemoteTo(half, part(2)), hn::DemoteTo(half, part(0)));
  }
}

HWY_INLINE void gather(const std::array<std::uint32_t, 4>* HWY_RESTRICT nodes, const NodeVector* HWY_RESTRICT x,
                       float* HWY_RESTRICT edges) {
  const Floats df;
  for (std::size_t first = 0; first < kLanes; first += 4) {
    for (std::size_t n = 0; n < 3; ++n) {
      hn::Vec<Floats> v[4];
      for (std::size_t i = 0; i < 4; ++i) {
        const std::array<std::uint32_t, 4>& of = nodes[first + i];
        v[i] = difference(Doubles(), x[of[n + 1]], x[of[0]]);
      }
      const auto xy01 = hn::InterleaveLower(df, v[0], v[1]);
      const auto xy23 = hn::InterleaveLower(df, v[2], v[3]);
      const auto z01 = hn::InterleaveUpper(df, v[0], v[1]);
      const auto z23 = hn::InterleaveUpper(df, v[2], v[3]);
      hn::Store(hn::ConcatLowerLower(df, xy23, xy01), df, edges + n * kLanes + first);
      hn::Store(hn::ConcatUpperUpper(df, xy23, xy01), df, edges + (3 + n) * kLanes + first);
      hn::Store(hn::ConcatLowerLower(df, z23, z01), df, edges + (6 + n) * kLanes + first);
    }
  }
}

template <class DD>
HWY_INLINE void scatter_by(DD dd, const std::array<std::uint32_t, 4>* HWY_RESTRICT nodes,
                           const float* HWY_RESTRICT forces, NodeVector* HWY_RESTRICT f) {
  const Floats df;
  constexpr std::size_t kParts = 4 / hn::MaxLanes(DD());
  for (std::size_t first = 0; first < kLanes; first += 4) {
    hn::Vec<Floats> v[3][4];
    for (std::size_t n = 0; n < 3; ++n) {
      const auto x = hn::Load(df, forces + n * kLanes + first);
      const auto y = hn::Load(df, forces + (3 + n) * kLanes + first);
      const auto z = hn::Load(df, forces + (6 + n) * kLanes + first);
      const auto xy01 = hn::InterleaveLower(df, x, y);
      const auto xy23 = hn::InterleaveUpper(df, x, y);
      const auto z01 = hn::InterleaveLower(df, z, hn::Zero(df));
      const auto z23 = hn::InterleaveUpper(df, z, hn::Zero(df));
      v[n][0] = hn::ConcatLowerLower(df, z01, xy01);
      v[n][1] = hn::ConcatUpperUpper(df, z01, xy01);
      v[n][2] = hn::ConcatLowerLower(df, z23, xy23);
      v[n][3] = hn::ConcatUpperUpper(df, z23, xy23);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      const std::array<std::uint32_t, 4>& of = nodes[first + i];
      for (std::size_t part = 0; part < kParts; ++part) {
        const auto force = [&](std::size_t n) HWY_ATTR {
          if constexpr (kParts == 1) {
            return hn::PromoteTo(dd, v[n][i]);
          } else {
            const hn::Half<Floats> half;
            return hn::PromoteTo(dd, part == 0 ? hn::LowerHalf(half, v[n][i]) : hn::UpperHalf(half, v[n][i]));
          }
        };
        const std::size_t at = part * hn::MaxLanes(dd);
        const auto add = [&](std::uint32_t node, const auto& value) HWY_ATTR {
          double* const to = f[node].xyz0.data() + at;
          hn::Store(hn::Add(hn::Load(dd, to), value), dd, to);
        };
        const auto f1 = force(0);
        const auto f2 = force(1);
        const auto f3 = force(2);
        add(of[1], f1);
        add(of[2], f2);
        add(of[3], f3);
        add(of[0], hn::Neg(hn::Add(hn::Add(f1, f2), f3)));
      }
    }
  }
}

HWY_INLINE void scatter(const std::array<std::uint32_t, 4>* HWY_RESTRICT nodes, const float* HWY_RESTRICT forces,
                        NodeVector* HWY_RESTRICT f) {
  scatter_by(Doubles(), nodes, forces, f);
}

#endif

KernelSums element_forces(ElementBlocks& blocks, const NodeVector* HWY_RESTRICT x, NodeVector* HWY_RESTRICT f) {
  const hn::CappedTag<float, kLanes> d;
  const std::size_t step = hn::Lanes(d);
  LaneSums<hn::CappedTag<float, kLanes>> all{hn::Zero(d), hn::Zero(d), hn::Zero(d), 0};
  // Edges of a block are made while the one before is computed: they are stored in other parts than they are loaded.
  alignas(64) float edges[2][9 * kLanes];
  alignas(64) float forces[9 * kLanes];
  const std::size_t count = blocks.blocks();
  if (count > 0) gather(blocks.nodes.data(), x, edges[0]);
  for (std::size_t block = 0; block < count; ++block) {
    const std::size_t next = block + 1;
    if (next < count) gather(blocks.nodes.data() + next * kLanes, x, edges[next % 2]);
    for (std::size_t lane = 0; lane < kLanes; lane += step) {
      lanes(d, blocks.material[block * ElementBlocks::kMaterialValues].lane.data() + lane, edges[block % 2] + lane,
            blocks.last_strain[block * 6].lane.data() + lane, forces + lane, blocks.strain[block].lane.data() + lane,
            blocks.load[block].lane.data() + lane, all);
    }
    scatter(blocks.nodes.data() + block * kLanes, forces, f);
  }
  KernelSums sums;
  sums.largest_strain = hn::GetLane(hn::MaxOfLanes(d, all.strain));
  sums.largest_load = hn::GetLane(hn::MaxOfLanes(d, all.load));
  sums.inverted = static_cast<std::uint32_t>(all.inverted);
  sums.energy = 0.5 * static_cast<double>(hn::GetLane(hn::SumOfLanes(d, all.twice_energy)));
  return sums;
}

}  // namespace cellmirror::tissue::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace cellmirror::tissue {

HWY_EXPORT(element_forces);

void ElementBlocks::resize(std::size_t places) {
  count = places;
  material.resize(blocks() * kMaterialValues);
  last_strain.resize(blocks() * 6);
  nodes.resize(blocks() * kLanes);
  strain.resize(blocks());
  load.resize(blocks());
}

KernelSums compute_element_forces(ElementBlocks& blocks, std::span<const NodeVector> x, std::span<NodeVector> f) {
  return HWY_DYNAMIC_DISPATCH(element_forces)(blocks, x.data(), f.data());
}

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
