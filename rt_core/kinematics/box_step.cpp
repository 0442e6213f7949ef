#include "rt_core/kinematics/box_step.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror::kinematics {

namespace {

// The lower triangle of a symmetric matrix.
using Matrix6 = std::array<Six, 6>;

inline void add_outer(const Six& c, double sign, Matrix6& A) CELL_RT {
  for (std::size_t i = 0; i < 6; ++i) {
    const double a = sign * c[i];
    for (std::size_t j = 0; j <= i; ++j) A[i][j] += a * c[j];
  }
}

inline void add_multiple(double factor, const Six& c, Six& e) CELL_RT {
  for (std::size_t k = 0; k < 6; ++k) e[k] += factor * c[k];
}

inline double dot(const Six& a, const Six& b) CELL_RT {
  double sum = 0;
  for (std::size_t k = 0; k < 6; ++k) sum += a[k] * b[k];
  return sum;
}

// y = (A + damping I)^-1 e by L D L^T.
inline Six solve(const Matrix6& A, double damping, const Six& e) CELL_RT {
  constexpr double kLeastPivot = 1e-30;  // rounding may make a pivot of a singular A negative
  Matrix6 L;                             // times D
  Six inverse;
  for (std::size_t j = 0; j < 6; ++j) {
    Six scaled;
    double pivot = A[j][j] + damping;
    for (std::size_t k = 0; k < j; ++k) {
      scaled[k] = L[j][k] * inverse[k];
      pivot -= L[j][k] * scaled[k];
    }
    inverse[j] = 1.0 / std::max(pivot, kLeastPivot);
    for (std::size_t i = j + 1; i < 6; ++i) {
      double sum = A[i][j];
      for (std::size_t k = 0; k < j; ++k) sum -= L[i][k] * scaled[k];
      L[i][j] = sum;
    }
  }
  Six y;
  for (std::size_t i = 0; i < 6; ++i) {
    double sum = e[i];
    for (std::size_t k = 0; k < i; ++k) sum -= L[i][k] * y[k];
    y[i] = sum * inverse[i];
  }
  for (std::size_t i = 6; i-- > 0;) {
    double sum = 0;
    for (std::size_t k = i + 1; k < 6; ++k) sum += L[k][i] * y[k];
    y[i] -= sum * inverse[i];
  }
  return y;
}

// The part of a step that is not decided yet.
struct Remainder {
  Matrix6 A{};  // J J^T of the variables that are free to move
  Six e{};
  std::array<bool, kMaxVariables> fixed{};
};

template <bool kTowards>
double solve_in_box(const Linearised& at, const Room& room, double damping, Remainder& left,
                    const std::array<double, kMaxVariables>& wished, std::array<double, kMaxVariables>& dq) CELL_RT {
  constexpr int kPasses = 4;  // each puts at least one more variable to its border; a step need not be the best one
  double largest = 0;
  for (int pass = 0; pass < kPasses; ++pass) {
    const Six y = solve(left.A, damping, left.e);
    bool again = false;
    largest = 0;
    for (std::size_t i = 0; i < at.variables; ++i) {
      if (!left.fixed[i]) {
        const double wish = kTowards ? wished[i] : 0.0;
        const double step = wish + dot(at.column[i], y);
        dq[i] = std::min(std::max(step, room.below[i]), room.above[i]);
        if (dq[i] != step) {
          left.fixed[i] = true;
          again = true;
          add_outer(at.column[i], -1.0, left.A);
          add_multiple(wish - dq[i], at.column[i], left.e);
        }
      }
      largest = std::max(largest, std::abs(dq[i]));
    }
    if (!again) break;
  }
  return largest;
}

}  // namespace

double box_step(const Linearised& at, const Room& room, double damping, std::array<double, kMaxVariables>& dq) CELL_RT {
  Remainder left;
  left.e = at.e;
  for (std::size_t i = 0; i < at.variables; ++i) {
    dq[i] = 0;
    const double downhill = dot(at.column[i], at.e);
    left.fixed[i] = (downhill > 0 && room.above[i] <= 0) || (downhill < 0 && room.below[i] >= 0);
    if (!left.fixed[i]) add_outer(at.column[i], 1.0, left.A);
  }
  return solve_in_box<false>(at, room, damping, left, dq, dq);
}

double box_step_towards(const Linearised& at, const Room& room, double damping,
                        const std::array<double, kMaxVariables>& wished,
                        std::array<double, kMaxVariables>& dq) CELL_RT {
  Remainder left;
  left.e = at.e;
  for (std::size_t i = 0; i < at.variables; ++i) {
    dq[i] = 0;
    add_outer(at.column[i], 1.0, left.A);
    add_multiple(-wished[i], at.column[i], left.e);
  }
  return solve_in_box<true>(at, room, damping, left, wished, dq);
}

}  // namespace cellmirror::kinematics
