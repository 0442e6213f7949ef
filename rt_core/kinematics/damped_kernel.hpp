// The damped least squares search inside the box of the limits, on packed chains, compile-time sized. Included by the
// sources that instantiate it, and by nothing else. Real-time class: all of it may run in the tick.
//
// Step: dq = J^T (J J^T + lambda I)^-1 e over the joints that are free to move, with lambda proportional to the squared
// error (Sugihara, Solvability-unconcerned inverse kinematics by the Levenberg-Marquardt method, IEEE T-RO 27(5),
// 2011), so that singular targets converge too. J J^T is 6 x 6 whatever the number of joints. A joint that a step would
// take over its limit is put there and taken out, and the step is solved again for the rest.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "rt_core/kinematics/packed_chain.hpp"

namespace cellmirror::kinematics::kernel {

using Six = std::array<double, 6>;

// Error and Jacobian at one posture, orientation rows weighted. N: number of variables of a plain chain, 0: any chain.
template <int N>
struct Evaluation {
  static constexpr std::size_t kCapacity = N > 0 ? N : kMaxVariables;
  Six e{};
  std::array<Six, kCapacity> column{};
  double cost = 0;  // half the squared length of e
};

template <int N>
struct Frames {
  static constexpr std::size_t kCapacity = N > 0 ? N : kMaxChainJoints;
  std::array<double, 3 * kCapacity> origin;
  std::array<double, 3 * kCapacity> axis;
  double R[9];
  double p[3];
};

struct Weights {
  double orientation = 1;
};

template <int N>
inline int variables_of(const PackedChain& chain) noexcept {
  return N > 0 ? N : chain.variables;
}
template <int N>
inline int joints_of(const PackedChain& chain) noexcept {
  return N > 0 ? N : chain.joints;
}

// Forward kinematics: the axes, and the last frame with the tip as its origin.
template <int N>
inline void walk(const PackedChain& chain, const double* q, Frames<N>& at) noexcept {
  double x[3] = {chain.start_R[0], chain.start_R[1], chain.start_R[2]};
  double y[3] = {chain.start_R[3], chain.start_R[4], chain.start_R[5]};
  double z[3] = {chain.start_R[6], chain.start_R[7], chain.start_R[8]};
  double p[3] = {chain.start_p[0], chain.start_p[1], chain.start_p[2]};
  const int joints = joints_of<N>(chain);
  double sine[Frames<N>::kCapacity];
  double cosine[Frames<N>::kCapacity];
  for (int i = 0; i < joints; ++i) {
    const PackedJoint& joint = chain.joint[static_cast<std::size_t>(i)];
    const double value = N > 0 ? q[i] : joint.multiplier * q[joint.variable];
    const double angle = joint.prismatic ? joint.offset : value + joint.offset;
    sine[i] = std::sin(angle);
    cosine[i] = std::cos(angle);
  }
  for (int i = 0; i < joints; ++i) {
    const PackedJoint& joint = chain.joint[static_cast<std::size_t>(i)];
    if (joint.prismatic) {
      const double way = (N > 0 ? q[i] : joint.multiplier * q[joint.variable]) + joint.slide;
      for (int k = 0; k < 3; ++k) p[k] += way * z[k];
    }
    const double c = cosine[i];
    const double s = sine[i];
    for (int k = 0; k < 3; ++k) {
      at.origin[static_cast<std::size_t>(3 * i + k)] = p[k];
      at.axis[static_cast<std::size_t>(3 * i + k)] = z[k];
      const double x_turned = c * x[k] + s * y[k];
      const double y_turned = c * y[k] - s * x[k];
      p[k] += joint.t[0] * x_turned + joint.t[1] * y_turned + joint.t[2] * z[k];
      x[k] = x_turned;
      y[k] = joint.cos_x * y_turned + joint.sin_x * z[k];
      z[k] = joint.cos_x * z[k] - joint.sin_x * y_turned;
    }
  }
  for (int k = 0; k < 3; ++k) {
    at.R[k] = x[k];
    at.R[3 + k] = y[k];
    at.R[6 + k] = z[k];
    at.p[k] = p[k];
  }
}

// angle / sin(angle) from both, angle within [0, pi).
inline double turn_per_sine(double sine, double cosine) noexcept {
  if (cosine > 0 && sine < 1e-2) {
    const double s2 = sine * sine;
    return 1.0 + s2 * (1.0 / 6.0 + s2 * (3.0 / 40.0));
  }
  return std::atan2(sine, cosine) / sine;
}

// The rotation vector of E = G R^T near half a turn, where its skew part vanishes: the axis is a column of E + I.
inline void half_turn(const double* G, const double* R, double angle, double* w) noexcept {
  double E[3][3];
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) E[i][j] = G[i] * R[j] + G[3 + i] * R[3 + j] + G[6 + i] * R[6 + j];
  }
  int best = 0;
  for (int i = 1; i < 3; ++i) {
    if (E[i][i] > E[best][best]) best = i;
  }
  double axis[3];
  double norm = 0;
  for (int i = 0; i < 3; ++i) {
    axis[i] = 0.5 * (E[i][best] + E[best][i]) + (i == best ? 1.0 : 0.0);
    norm += axis[i] * axis[i];
  }
  const double sense = axis[0] * w[0] + axis[1] * w[1] + axis[2] * w[2] < 0 ? -1.0 : 1.0;
  const double factor = sense * angle / std::sqrt(norm);
  for (int i = 0; i < 3; ++i) w[i] = factor * axis[i];
}

inline void rotation_error(const double* G, const double* R, double* w) noexcept {
  double cross[3] = {0, 0, 0};
  double dot = 0;
  for (int c = 0; c < 9; c += 3) {
    cross[0] += R[c + 1] * G[c + 2] - R[c + 2] * G[c + 1];
    cross[1] += R[c + 2] * G[c] - R[c] * G[c + 2];
    cross[2] += R[c] * G[c + 1] - R[c + 1] * G[c];
    dot += R[c] * G[c] + R[c + 1] * G[c + 1] + R[c + 2] * G[c + 2];
  }
  for (int k = 0; k < 3; ++k) w[k] = 0.5 * cross[k];
  const double sine = std::sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
  const double cosine = 0.5 * (dot - 1.0);
  if (cosine < -0.99) {
    half_turn(G, R, std::atan2(sine, cosine), w);
    return;
  }
  const double factor = turn_per_sine(sine, cosine);
  for (int k = 0; k < 3; ++k) w[k] *= factor;
}

// The shortest turn of the tool's axis `a` into `aim`.
inline void vector_error(const double* a, const double* aim, double* w) noexcept {
  w[0] = a[1] * aim[2] - a[2] * aim[1];
  w[1] = a[2] * aim[0] - a[0] * aim[2];
  w[2] = a[0] * aim[1] - a[1] * aim[0];
  const double sine = std::sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
  const double cosine = a[0] * aim[0] + a[1] * aim[1] + a[2] * aim[2];
  if (cosine < 0 && sine < 1e-9) {  // opposite: any axis across will do
    const int least = std::abs(a[0]) < 0.7 ? 0 : 1;
    const double h[3] = {least == 0 ? 1.0 : 0.0, least == 1 ? 1.0 : 0.0, 0.0};
    const double across[3] = {a[1] * h[2] - a[2] * h[1], a[2] * h[0] - a[0] * h[2], a[0] * h[1] - a[1] * h[0]};
    const double norm = std::sqrt(across[0] * across[0] + across[1] * across[1] + across[2] * across[2]);
    for (int k = 0; k < 3; ++k) w[k] = M_PI * across[k] / norm;
    return;
  }
  const double factor = turn_per_sine(sine, cosine);
  for (int k = 0; k < 3; ++k) w[k] *= factor;
}

// Adds the column of one joint: what moves the tip, by the coordinates that count, and turns it.
inline void add_column(const double* axis, const double* origin, const double* tip, const PackedJoint& joint,
                       double multiplier, const PackedGoal& goal, double weight, Six& column) noexcept {
  if (joint.prismatic) {
    for (std::size_t k = 0; k < 3; ++k) column[k] += multiplier * goal.row[k] * axis[k];
    return;
  }
  const double r[3] = {tip[0] - origin[0], tip[1] - origin[1], tip[2] - origin[2]};
  column[0] += multiplier * goal.row[0] * (axis[1] * r[2] - axis[2] * r[1]);
  column[1] += multiplier * goal.row[1] * (axis[2] * r[0] - axis[0] * r[2]);
  column[2] += multiplier * goal.row[2] * (axis[0] * r[1] - axis[1] * r[0]);
  for (std::size_t k = 0; k < 3; ++k) column[3 + k] += multiplier * weight * axis[k];
}

template <int N>
inline void evaluate(const PackedChain& chain, const PackedGoal& goal, const double* q, double weight,
                     Evaluation<N>& at) noexcept {
  Frames<N> frames;
  walk<N>(chain, q, frames);
  at.e.fill(0.0);
  for (std::size_t k = 0; k < 3; ++k) at.e[k] = goal.row[k] * (goal.p[k] - frames.p[k]);
  double tool[3] = {0, 0, 0};
  const bool full = goal.orientation == OrientationTask::full;
  const bool vector = !full && goal.orientation != OrientationTask::free;
  if (full) {
    rotation_error(goal.R.data(), frames.R, &at.e[3]);
  } else if (vector) {
    for (std::size_t k = 0; k < 3; ++k) {
      tool[k] = frames.R[k] * goal.tool[0] + frames.R[3 + k] * goal.tool[1] + frames.R[6 + k] * goal.tool[2];
    }
    vector_error(tool, goal.aim.data(), &at.e[3]);
  }
  const double row_weight = full || vector ? weight : 0.0;
  at.cost = 0;
  for (std::size_t k = 0; k < 6; ++k) {
    if (k >= 3) at.e[k] *= row_weight;
    at.cost += 0.5 * at.e[k] * at.e[k];
  }
  if constexpr (N == 0) {
    for (Six& column : at.column) column.fill(0.0);
  }
  const int joints = joints_of<N>(chain);
  for (int i = 0; i < joints; ++i) {
    const PackedJoint& joint = chain.joint[static_cast<std::size_t>(i)];
    const double* axis = &frames.axis[static_cast<std::size_t>(3 * i)];
    const double* origin = &frames.origin[static_cast<std::size_t>(3 * i)];
    Six& column = at.column[N > 0 ? static_cast<std::size_t>(i) : joint.variable];
    if constexpr (N > 0) column.fill(0.0);
    add_column(axis, origin, frames.p, joint, N > 0 ? 1.0 : joint.multiplier, goal, row_weight, column);
  }
  if (!vector) return;
  const int variables = variables_of<N>(chain);
  for (int i = 0; i < variables; ++i) {  // turning about the tool's own axis is free
    Six& column = at.column[static_cast<std::size_t>(i)];
    const double along = column[3] * tool[0] + column[4] * tool[1] + column[5] * tool[2];
    for (std::size_t k = 0; k < 3; ++k) column[3 + k] -= along * tool[k];
  }
}

// y = (A + lambda I)^-1 e for the symmetric positive A, of which the lower triangle is given; by L D L^T.
inline void solve_six(const double A[6][6], double lambda, const Six& e, Six& y) noexcept {
  double L[6][6];
  double inverse[6];
  for (int j = 0; j < 6; ++j) {
    double d = A[j][j] + lambda;
    for (int k = 0; k < j; ++k) d -= L[j][k] * L[j][k] * inverse[k];
    inverse[j] = 1.0 / std::max(d, 1e-30);
    for (int i = j + 1; i < 6; ++i) {
      double sum = A[i][j];
      for (int k = 0; k < j; ++k) sum -= L[i][k] * L[j][k] * inverse[k];
      L[i][j] = sum;
    }
  }
  for (int i = 0; i < 6; ++i) {
    double sum = e[static_cast<std::size_t>(i)];
    for (int k = 0; k < i; ++k) sum -= L[i][k] * inverse[k] * y[static_cast<std::size_t>(k)];
    y[static_cast<std::size_t>(i)] = sum;
  }
  for (int i = 5; i >= 0; --i) {
    double sum = y[static_cast<std::size_t>(i)];
    for (int k = i + 1; k < 6; ++k) sum -= L[k][i] * y[static_cast<std::size_t>(k)];
    y[static_cast<std::size_t>(i)] = sum * inverse[i];
  }
}

inline void add_outer(const Six& c, double sign, double A[6][6]) noexcept {
  for (std::size_t i = 0; i < 6; ++i) {
    const double a = sign * c[i];
    for (std::size_t j = 0; j <= i; ++j) A[i][j] += a * c[j];
  }
}

// The step from q towards `wanted` change of the error, and `pull`, what each joint would move if it were alone (null
// for none). It ends within the limits. Returns its largest component.
template <int N>
inline double box_step(const PackedChain& chain, const Evaluation<N>& at, const double* q, const double* pull,
                       double lambda, double* dq) noexcept {
  const int n = variables_of<N>(chain);
  bool fixed[Evaluation<N>::kCapacity];
  double A[6][6] = {};
  Six e = at.e;
  for (int i = 0; i < n; ++i) {
    const Six& c = at.column[static_cast<std::size_t>(i)];
    double towards = 0;
    for (std::size_t k = 0; k < 6; ++k) towards += c[k] * at.e[k];
    const std::size_t v = static_cast<std::size_t>(i);
    if (pull != nullptr) towards = 0;
    fixed[i] = (towards > 0 && q[i] >= chain.upper[v]) || (towards < 0 && q[i] <= chain.lower[v]);
    dq[i] = 0;
    if (fixed[i]) continue;
    add_outer(c, 1.0, A);
    if (pull == nullptr) continue;
    for (std::size_t k = 0; k < 6; ++k) e[k] -= c[k] * pull[i];
  }
  double largest = 0;
  for (int pass = 0; pass < 4; ++pass) {
    Six y{};
    solve_six(A, lambda, e, y);
    bool again = false;
    largest = 0;
    for (int i = 0; i < n; ++i) {
      const std::size_t v = static_cast<std::size_t>(i);
      if (!fixed[i]) {
        const Six& c = at.column[v];
        double step = pull == nullptr ? 0.0 : pull[i];
        for (std::size_t k = 0; k < 6; ++k) step += c[k] * y[k];
        const double bounded = std::min(std::max(step, chain.lower[v] - q[i]), chain.upper[v] - q[i]);
        dq[i] = bounded;
        if (bounded != step) {
          fixed[i] = true;
          again = true;
          add_outer(c, -1.0, A);
          const double taken = bounded - (pull == nullptr ? 0.0 : pull[i]);
          for (std::size_t k = 0; k < 6; ++k) e[k] -= c[k] * taken;
        }
      }
      largest = std::max(largest, std::abs(dq[i]));
    }
    if (!again) break;
  }
  return largest;
}

struct Stop {
  Six tolerance{};  // of each component of e, as it is weighted
  int max_iterations = 20;
  double smallest_step = 0;  // rad or units of length: a shorter one ends the search (0: only what cannot improve)
};

struct Outcome {
  bool met = false;
  int iterations = 0;
};

inline bool within(const Six& e, const Six& tolerance) noexcept {
  bool all = true;
  for (std::size_t k = 0; k < 6; ++k) all = all && std::abs(e[k]) <= tolerance[k];
  return all;
}

// From q downhill; q and `at` are left at the best posture, which has to lie within the limits at the start.
template <int N>
inline Outcome descend(const PackedChain& chain, const PackedGoal& goal, double weight, const Stop& stop, double* q,
                       Evaluation<N>& at) noexcept {
  constexpr double kFloor = 1e-13;     // keeps J J^T + lambda I regular at a singular posture that meets the goal
  constexpr double kDamping = 0.1;     // first lambda as a share of the cost
  constexpr double kLeastGain = 1e-3;  // a step that gains less counts as standing still
  constexpr int kStandstills = 3;
  const int n = variables_of<N>(chain);
  evaluate<N>(chain, goal, q, weight, at);
  Evaluation<N> next;
  double dq[Evaluation<N>::kCapacity];
  double candidate[Evaluation<N>::kCapacity];
  double mu = kDamping;
  int still = 0;
  Outcome outcome;
  while (!(outcome.met = within(at.e, stop.tolerance)) && outcome.iterations < stop.max_iterations) {
    ++outcome.iterations;
    const double largest = box_step<N>(chain, at, q, nullptr, mu * at.cost + kFloor, dq);
    if (!(largest > 1e-12)) break;
    for (int i = 0; i < n; ++i) {
      const std::size_t v = static_cast<std::size_t>(i);
      candidate[i] = std::min(std::max(q[i] + dq[i], chain.lower[v]), chain.upper[v]);
    }
    evaluate<N>(chain, goal, candidate, weight, next);
    const double gain = at.cost - next.cost;
    if (gain > 0) {
      still = gain < kLeastGain * at.cost ? still + 1 : 0;
      for (int i = 0; i < n; ++i) q[i] = candidate[i];
      at = next;
      mu = std::max(0.2 * mu, 1e-4);
      if (largest < stop.smallest_step) break;
    } else {
      mu = std::min(10.0 * mu, 1e6);
      ++still;
    }
    if (still >= kStandstills) break;
  }
  return outcome;
}

}  // namespace cellmirror::kinematics::kernel
