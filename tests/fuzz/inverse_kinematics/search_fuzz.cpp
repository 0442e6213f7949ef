// Any chain, any target, any task: a search ends, stays within the limits, and never claims what the plain forward
// kinematics does not say. Each input is read as a sequence of small numbers; the text of a seed is as good as any.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <span>

#include "rt_core/inverse_kinematics/closed_form.hpp"
#include "rt_core/inverse_kinematics/inverse_kinematics.hpp"
#include "rt_core/inverse_kinematics/seed_table.hpp"
#include "rt_core/kinematics/fast_step.hpp"
#include "rt_core/kinematics/null_space.hpp"

namespace {

using namespace cellmirror;
using inverse_kinematics::Answer;

class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data, size) {}
  unsigned below(unsigned end) { return next() % end; }
  // Round numbers, so that axes meet and align as they do in real arms; some are far out or no numbers.
  double number() {
    const unsigned kind = next();
    const double value = (static_cast<double>(next()) - 128.0) / 64.0;
    if (kind == 255) return std::numeric_limits<double>::quiet_NaN();
    if (kind == 254) return value * 1e9;
    if (kind == 253) return value * 1e-9;
    return kind % 2 == 0 ? std::round(value) : value;
  }

 private:
  unsigned next() {
    if (data_.empty()) return 0;
    const unsigned byte = data_.front();
    data_ = data_.subspan(1);
    return byte;
  }
  std::span<const std::uint8_t> data_;
};

Pose pose_from(Bytes& bytes) {
  const double quarter = std::numbers::pi / 2;
  const Eigen::Vector3d xyz(bytes.number(), bytes.number(), bytes.number());
  return pose_from_xyz_rpy(xyz, quarter * Eigen::Vector3d(bytes.number(), bytes.number(), bytes.number()));
}

Result<kinematics::Chain> chain_from(Bytes& bytes) {
  const std::size_t count = 1 + bytes.below(10);
  const bool mimics = bytes.below(8) == 0;
  std::vector<kinematics::Variable> variables;
  std::vector<kinematics::ChainJoint> joints(count);
  for (kinematics::ChainJoint& joint : joints) {
    joint.X_PJ = pose_from(bytes);
    joint.kind = static_cast<JointKind>(bytes.below(3));
    if (mimics && !variables.empty() && bytes.below(3) == 0) {
      joint.variable = static_cast<std::uint8_t>(bytes.below(static_cast<unsigned>(variables.size())));
      joint.kind = variables[joint.variable].kind;
      joint.multiplier = bytes.number();
      joint.offset = bytes.number();
      continue;
    }
    joint.variable = static_cast<std::uint8_t>(variables.size());
    const double lower = bytes.number();
    variables.push_back({"q", joint.kind, lower, lower + std::abs(bytes.number()) * 3});
  }
  return kinematics::Chain::make(std::move(variables), joints, pose_from(bytes));
}

void expect(bool condition) {
  if (!condition) std::abort();
}

void check(const kinematics::Chain& chain, const kinematics::Task& task, const Pose& X_BG, const JointValues& q,
           bool claimed) {
  const std::span<const double> values(q.data(), chain.variable_count());
  expect(chain.within_limits(values));
  const auto error = kinematics::task_error(task, kinematics::forward(chain, values), X_BG);
  if (claimed) expect(kinematics::meets(task, error, 1e-5));
}

// Whatever the arm and the target: finite angles, and as many as there is room for.
void try_closed_form(const kinematics::Chain& chain, const Pose& X_BG) {
  const auto form = inverse_kinematics::ClosedForm::analyse(chain);
  if (!form) return;
  std::array<JointValues, inverse_kinematics::kMaxClosedForms> postures;
  const std::size_t count = form->solve(X_BG, postures);
  expect(count <= postures.size());
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < chain.variable_count(); ++k) expect(std::isfinite(postures[i][k]));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  const auto made = chain_from(bytes);
  if (!made) return 0;
  const kinematics::Chain& chain = *made;
  const std::size_t n = chain.variable_count();
  inverse_kinematics::Request request;
  request.task = kinematics::task_of(static_cast<InverseClass>(bytes.below(25)), chain);
  request.max_solutions = 1 + bytes.below(4);
  request.time_limit = std::chrono::milliseconds(1);
  JointValues there{};
  for (std::size_t i = 0; i < n; ++i) {
    request.present[i] = bytes.number();
    there[i] = std::clamp(bytes.number(), chain.lower()[i], chain.upper()[i]);
  }
  request.X_BG = bytes.below(2) == 0 ? kinematics::forward(chain, {there.data(), n}) : pose_from(bytes);

  try_closed_form(chain, request.X_BG);
  const ManualClock clock;  // stands still: what an input does depends on its bytes alone
  const auto solver = inverse_kinematics::make_solver(inverse_kinematics::Method::fast, chain, clock);
  const Result<Answer> answer = solver->solve(request);
  if (!answer) {
    expect(!answer.error().what.empty());
    return 0;
  }
  expect(!answer->solutions.empty() && answer->solutions.size() <= request.max_solutions);
  for (const auto& solution : answer->solutions) check(chain, request.task, request.X_BG, solution.q, answer->solved);

  const inverse_kinematics::SeedTable table(chain, 64);
  std::array<inverse_kinematics::Seed, 8> seeds;
  const std::size_t found = table.find(request.X_BG, answer->solutions[0].q, seeds);
  for (std::size_t i = 0; i < found; ++i) {
    JointValues q = seeds[i].q;
    expect(chain.within_limits({q.data(), n}));
    const auto result = kinematics::fast_solve(chain, request.task, request.X_BG, {q.data(), n}, {});
    check(chain, request.task, request.X_BG, q, result.solved);
    if (!result.solved) continue;
    kinematics::settle(chain, request.task, request.X_BG, {there.data(), n}, {q.data(), n}, {});
    check(chain, request.task, request.X_BG, q, true);
  }
  return 0;
}
