// Any bytes as a CSV of postures: findings, or joint values that are finite and belong to a robot.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>

#include "config/posture_file.hpp"
#include "rt_core/base/contract.hpp"
#include "tests/unit/cell/cell_from_text.hpp"

namespace {

using namespace cellmirror;

const Cell& two_arms() {
  static const Cell cell = [] {
    auto files = std::make_shared<TextFiles>();
    files->add("arm.mpc", kArm);
    Diagnostics findings;
    auto built = build_cell(
        "[[node]]\nname = \"A\"\nabstract = \"arm.mpc\"\n"
        "[[node]]\nname = \"B\"\nabstract = \"arm.mpc\"\nrobot_id = \"ARM_2\"\n",
        files, findings);
    CELLMIRROR_EXPECTS(built.has_value());
    return std::move(*built);
  }();
  return cell;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kLargest = 64UL << 10U;
  if (size > kLargest) return 0;
  std::istringstream in(std::string(reinterpret_cast<const char*>(data), size));
  Diagnostics diagnostics;
  PostureReader sut(in, "fuzz.csv", two_arms(), diagnostics);
  std::vector<JointValues> q = two_arms().start_positions();
  if (!sut.read_header()) {
    CELLMIRROR_EXPECTS(!diagnostics.ok());
    return 0;
  }
  CELLMIRROR_EXPECTS(sut.columns() >= 1 && sut.columns() <= 6);
  std::uint64_t rows = 0;
  while (sut.read_row(q)) {
    ++rows;
    for (const JointValues& joints : q) {
      for (const double value : joints) CELLMIRROR_EXPECTS(std::abs(value) <= kGreatestJointValue);
    }
  }
  CELLMIRROR_EXPECTS(rows == sut.rows() && rows <= size);
  sut.finish();
  CELLMIRROR_EXPECTS(rows > 0 || !diagnostics.ok());
  return 0;
}
