#include "rt_core/inverse_kinematics/ipopt_ma27.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

// LAPACK 3, double precision. The trailing argument is the length of the Fortran string.
// NOLINTBEGIN(readability-identifier-naming): LAPACK names them.
extern "C" {
void dsytrf_(const char* uplo, const int* n, double* a, const int* lda, int* ipiv, double* work, const int* lwork,
             int* info, std::size_t);
void dsytrs_(const char* uplo, const int* n, const int* nrhs, const double* a, const int* lda, const int* ipiv,
             double* b, const int* ldb, int* info, std::size_t);
}
// NOLINTEND(readability-identifier-naming)

namespace {

// A: the factor (n x n, by columns), the scale of each row (n), then work. IW: the pivots of dsytrf (n).
constexpr int kBlock = 32;  // columns of work for dsytrf

constexpr int kInfoFlag = 0;
constexpr int kInfoDetail = 1;
constexpr int kInfoLengthA = 4;
constexpr int kInfoLengthIw = 5;
constexpr int kInfoNegative = 14;
constexpr int kInfoCount = 20;

constexpr int kIwTooShort = -3;
constexpr int kATooShort = -4;
constexpr int kSingular = -5;

int length_of_a(int n, int nz) { return n * n + n + std::max(nz, n * kBlock); }

// Scale so that no entry is above 1 and no row is all small: a congruence, which keeps the inertia.
// False: a row is zero or not finite.
bool equilibrate(int n, double* matrix, double* scale) {
  for (int i = 0; i < n; ++i) {
    double largest = 0.0;
    for (int j = 0; j < n; ++j) largest = std::max(largest, std::abs(matrix[std::max(i, j) + n * std::min(i, j)]));
    if (!(largest > 0.0) || !std::isfinite(largest)) return false;
    scale[i] = 1.0 / std::sqrt(largest);
  }
  for (int j = 0; j < n; ++j) {
    for (int i = j; i < n; ++i) matrix[i + n * j] *= scale[i] * scale[j];
  }
  return true;
}

// Counts the negative eigenvalues of the block-diagonal factor; -1: one is zero but for rounding.
int negative_eigenvalues(int n, const double* factor, const int* pivots) {
  const double zero = n * std::numeric_limits<double>::epsilon();
  int negative = 0;
  for (int k = 0; k < n; ++k) {
    const double d = factor[k + n * k];
    if (pivots[k] > 0) {
      if (!(std::abs(d) > zero)) return -1;
      negative += d < 0.0 ? 1 : 0;
      continue;
    }
    // A block of two rows: the eigenvalues have the sum and the product of trace and determinant.
    const double below = factor[k + 1 + n * k];
    const double next = factor[k + 1 + n * (k + 1)];
    const double determinant = d * next - below * below;
    if (!(std::abs(determinant) > zero * std::abs(below))) return -1;
    negative += determinant < 0.0 ? 1 : (d < 0.0 ? 2 : 0);
    ++k;
  }
  return negative;
}

}  // namespace

extern "C" {

void cellmirror_ma27id(int* icntl, double* cntl) {
  std::fill_n(icntl, 30, 0);
  std::fill_n(cntl, 5, 0.0);
}

void cellmirror_ma27ad(int* n, int* nz, const int* /*irn*/, const int* /*icn*/, int* /*iw*/, int* /*liw*/,
                       int* /*ikeep*/, int* /*iw1*/, int* nsteps, int* /*iflag*/, int* /*icntl*/, double* /*cntl*/,
                       int* info, double* ops) {
  std::fill_n(info, kInfoCount, 0);
  info[kInfoLengthA] = length_of_a(*n, *nz);
  info[kInfoLengthIw] = *n;
  *nsteps = 1;
  *ops = static_cast<double>(*n) * *n * *n / 3.0;
}

void cellmirror_ma27bd(int* n, int* nz, const int* irn, const int* icn, double* a, int* la, int* iw, int* liw,
                       int* /*ikeep*/, int* /*nsteps*/, int* maxfrt, int* /*iw1*/, int* /*icntl*/, double* /*cntl*/,
                       int* info) {
  std::fill_n(info, kInfoCount, 0);
  *maxfrt = 1;
  const int order = *n;
  if (*liw < order) {
    info[kInfoFlag] = kIwTooShort;
    info[kInfoDetail] = order;
    return;
  }
  if (*la < length_of_a(order, *nz)) {
    info[kInfoFlag] = kATooShort;
    info[kInfoDetail] = length_of_a(order, *nz);
    return;
  }
  double* const scale = a + order * order;
  double* const values = scale + order;
  std::copy_backward(a, a + *nz, values + *nz);
  std::fill_n(a, order * order, 0.0);
  for (int k = 0; k < *nz; ++k) {
    const int row = std::max(irn[k], icn[k]) - 1;
    const int column = std::min(irn[k], icn[k]) - 1;
    if (column >= 0 && row < order) a[row + order * column] += values[k];  // MA27 ignores places outside as well
  }
  int failed = 0;
  const int work = order * kBlock;
  if (equilibrate(order, a, scale)) {
    dsytrf_("L", n, a, n, iw, values, &work, &failed, 1);
  } else {
    failed = 1;
  }
  const int negative = failed == 0 ? negative_eigenvalues(order, a, iw) : -1;
  if (negative < 0) {
    info[kInfoFlag] = kSingular;
    return;
  }
  info[kInfoNegative] = negative;
}

void cellmirror_ma27cd(int* n, double* a, int* /*la*/, int* iw, int* /*liw*/, double* /*w*/, int* /*maxfrt*/,
                       double* rhs, int* /*iw1*/, int* /*nsteps*/, int* /*icntl*/, double* /*cntl*/) {
  const int order = *n;
  const double* const scale = a + order * order;
  for (int i = 0; i < order; ++i) rhs[i] *= scale[i];
  const int one = 1;
  int failed = 0;
  dsytrs_("L", n, &one, a, n, iw, rhs, n, &failed, 1);
  for (int i = 0; i < order; ++i) rhs[i] *= scale[i];
}

}  // extern "C"
