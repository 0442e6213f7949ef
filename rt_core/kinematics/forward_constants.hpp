// A chain in the form that forward kinematics reads: plain numbers, for sources that are compiled for several
// instruction sets (and so neither Eigen nor anything that is inline in a library). Private to this folder.
#pragma once

#include <cstddef>
#include <cstdint>

namespace cellmirror::kinematics {

struct ChainJoint;
inline constexpr std::size_t kMaxChainJoints = 32;  // mimics included

// Between two joints lies any constant pose. Its rotation is a turn about z, one about x and one about z; the outer two
// are added to what the joints before and after turn, so that a joint costs two plane rotations instead of a product of
// matrices. A joint then is: its way along z, its turn about z, `shift`, a turn about x.
struct ForwardConstants {
  struct Joint {
    double shift[3] = {};  // m, in the turned frame; z: the way of a prismatic joint at value zero included
    double cos_x = 1;
    double sin_x = 0;
    double slide = 0;   // m of way a unit of the variable
    double factor = 1;  // of the variable
    std::uint8_t variable = 0;
    bool prismatic = false;
  };
  // Writes the tip's pose (4 x 4) and, unless null, the Jacobian (6 x variables), column by column.
  using Kernel = void (*)(const ForwardConstants& chain, const double* q, double* X_BT, double* jacobian) noexcept;

  double X_B0[16] = {};  // where the first joint turns from zero, 4 x 4 column by column
  Joint joint[kMaxChainJoints];
  double turn[kMaxChainJoints] = {};       // rad a unit of the variable
  double turn_zero[kMaxChainJoints] = {};  // rad
  double tip_cos = 1;                      // the last turn about z
  double tip_sin = 0;
  std::size_t joints = 0;
  std::size_t variables = 0;
  bool plain = true;  // joint i moves by variable i alone
  Kernel pose = nullptr;
  Kernel pose_and_jacobian = nullptr;
};

// Of checked joints. X_LT: 4 x 4, column by column.
[[nodiscard]] ForwardConstants forward_constants(const ChainJoint* joints, std::size_t count, std::size_t variables,
                                                 bool plain, const double* X_LT);

// The kernels for a number of joints (0: any).
struct ForwardKernels {
  static constexpr std::size_t kSizes = 9;
  ForwardConstants::Kernel pose[kSizes];
  ForwardConstants::Kernel pose_and_jacobian[kSizes];
};
namespace baseline {
[[nodiscard]] ForwardKernels forward_kernels();
}
namespace avx2 {
[[nodiscard]] ForwardKernels forward_kernels();  // only where the processor has AVX2 and FMA
}

}  // namespace cellmirror::kinematics
