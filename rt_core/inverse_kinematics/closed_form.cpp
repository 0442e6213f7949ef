#include "rt_core/inverse_kinematics/closed_form.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "rt_core/kinematics/forward.hpp"

namespace cellmirror::inverse_kinematics {

namespace {

using closed_form::Axes;
using closed_form::kArmJoints;
using closed_form::Line;
using closed_form::Turn;
using closed_form::Vector;

constexpr double kExact = 1e-9;       // of reach: what rounding in a file's numbers of full length leaves
constexpr double kNearlySo = 0.02;    // of reach: more than any calibration finds, less than any offset by design
constexpr std::size_t kSamples = 16;  // postures that a candidate has to find again

// Every variable moves one joint, in order.
bool suits(const kinematics::Chain& chain, std::size_t joints) {
  if (chain.variable_count() != joints || chain.joints().size() != joints) return false;
  for (std::size_t i = 0; i < joints; ++i) {
    const kinematics::ChainJoint& joint = chain.joints()[i];
    if (joint.kind == JointKind::prismatic || joint.variable != i || std::abs(joint.multiplier) != 1.0) return false;
  }
  return true;
}

// The joints as lines in the base, all values zero; a joint that is walked against its sense has its axis turned round.
std::vector<Line> lines_at_zero(const kinematics::Chain& chain) {
  std::vector<Line> lines;
  Pose X_BJ = Pose::Identity();
  for (const kinematics::ChainJoint& joint : chain.joints()) {
    X_BJ = X_BJ * joint.X_PJ * Eigen::AngleAxisd(joint.offset, Vector::UnitZ());
    lines.push_back({(joint.multiplier * X_BJ.linear().col(2)).normalized(), X_BJ.translation()});
  }
  return lines;
}

// The lengths between neighbouring axes and to the tip: an upper bound of reach that is independent of the frames'
// positions along their axes.
double reach_of(std::span<const Line> lines, const Vector& tip) {
  double reach = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Vector next = i + 1 < lines.size() ? lines[i + 1].o : tip;
    reach += (next - lines[i].o).norm();
  }
  return std::max(reach, 1e-3);
}

Axes taken_from_tip(const Axes& axes) {
  Axes reversed;
  for (std::size_t i = 0; i < kArmJoints; ++i) reversed[i] = {-axes[kArmJoints - 1 - i].h, axes[kArmJoints - 1 - i].o};
  return reversed;
}

Pose turn_about(const Line& line, double angle) {
  Pose X = Pose::Identity();
  X.linear() = Eigen::AngleAxisd(angle, line.h).toRotationMatrix();
  X.translation() = line.o - X.linear() * line.o;
  return X;
}

template <typename Arm>
struct Choice {
  Arm arm;
  bool from_tip = false;
  std::string_view name;
  double deviation = 0;
  int rank = 0;
};

// Exact ones first, and of these the ones without a search; then the nearest.
int rank_of(bool exact, bool general) { return exact ? (general ? 1 : 0) : (general ? 3 : 2); }

template <typename Arm>
std::vector<Choice<Arm>> choices_of(const Axes& axes, double reach) {
  std::vector<Choice<Arm>> choices;
  const auto look = [&]<typename Family>(std::vector<typename Family::Candidate> found, bool from_tip) {
    Family::recognise(from_tip ? taken_from_tip(axes) : axes, reach, kNearlySo * reach, found);
    for (const auto& candidate : found) {
      choices.push_back({candidate.arm, from_tip, candidate.name, candidate.deviation,
                         rank_of(candidate.deviation <= kExact * reach, candidate.general)});
    }
  };
  for (const bool from_tip : {false, true}) {
    look.template operator()<closed_form::SphericalWrist>({}, from_tip);
    look.template operator()<closed_form::ThreeParallel>({}, from_tip);
  }
  std::ranges::stable_sort(choices, {}, [](const auto& c) { return std::tuple(c.rank, c.deviation); });
  return choices;
}

// Values all over the circle that do not repeat: multiples of irrational fractions of a turn.
JointValues sample_posture(std::size_t number) {
  JointValues q{};
  double fraction = 0.754877666246693;
  for (std::size_t i = 0; i < kArmJoints + 1; ++i, fraction *= 0.83) {
    q[i] = std::remainder(2 * std::numbers::pi * fraction * static_cast<double>(number + 1), 2 * std::numbers::pi);
  }
  return q;
}

}  // namespace

std::optional<ClosedForm> ClosedForm::analyse(const kinematics::Chain& chain) {
  if (!suits(chain, kArmJoints)) return std::nullopt;
  return analyse_arm(chain, std::nullopt);
}

std::optional<ClosedForm> ClosedForm::analyse_redundant(const kinematics::Chain& chain) {
  if (!suits(chain, kArmJoints + 1)) return std::nullopt;
  auto last = analyse_arm(chain, kArmJoints);
  if (last && last->exact()) return last;
  auto first = analyse_arm(chain, 0);
  return first && (!last || first->exact()) ? first : last;
}

std::optional<ClosedForm> ClosedForm::analyse_arm(const kinematics::Chain& chain, std::optional<std::size_t> held) {
  std::vector<Line> lines = lines_at_zero(chain);
  const Pose X_BT0 = kinematics::forward(chain, JointValues{});
  ClosedForm form;
  form.X_TB0_ = X_BT0.inverse();
  form.free_joint_ = held;
  if (held) {
    form.free_axis_ = lines[*held];
    lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(*held));
  }
  const double reach = reach_of(lines, X_BT0.translation());
  Axes axes;
  std::ranges::copy(lines, axes.begin());
  for (const auto& choice : choices_of<Arm>(axes, reach)) {
    form.arm_ = choice.arm;
    form.from_tip_ = choice.from_tip;
    form.family_ = choice.name;
    form.deviation_ = choice.deviation;
    form.exact_ = choice.deviation <= kExact * reach;
    if (form.finds_samples(chain)) return form;
  }
  return std::nullopt;
}

// Guards against degenerate arrangements that recognise() misses: a posture has to be among those found for its own
// pose, without help from a near posture, which arms that leave a joint free everywhere (fewer than six independent
// axes) would need. One sample may fall to a singularity.
bool ClosedForm::finds_samples(const kinematics::Chain& chain) const {
  const double tolerance = exact_ ? 1e-5 : 0.3;
  std::size_t found = 0;
  std::array<JointValues, kMaxClosedForms> postures;
  for (std::size_t k = 0; k < kSamples; ++k) {
    const JointValues q = sample_posture(k);
    JointValues near = sample_posture(k + kSamples);
    if (free_joint_) near[*free_joint_] = q[*free_joint_];
    const std::size_t count = solve(kinematics::forward(chain, q), postures, near);
    found += std::any_of(postures.begin(), postures.begin() + static_cast<std::ptrdiff_t>(count), [&](const auto& p) {
      for (std::size_t i = 0; i < chain.variable_count(); ++i) {
        if (!(std::abs(std::remainder(p[i] - q[i], 2 * std::numbers::pi)) <= tolerance)) return false;
      }
      return true;
    });
  }
  return found >= (exact_ ? kSamples - 1 : kSamples - 4);
}

std::size_t ClosedForm::solve(const Pose& X_BG, std::span<JointValues, kMaxClosedForms> out,
                              const JointValues& near) const noexcept {
  const std::size_t skip = free_joint_ == 0U ? 1 : 0;  // joints before those of the arm
  Pose X = X_BG * X_TB0_;
  if (free_joint_) {
    const Pose held = turn_about(free_axis_, -near[*free_joint_]);
    X = skip == 1 ? held * X : X * held;
  }
  if (!X.matrix().allFinite()) return 0;
  if (from_tip_) X = X.inverse();
  const auto joint_of = [&](std::size_t i) { return skip + (from_tip_ ? kArmJoints - 1 - i : i); };
  closed_form::Near arm_near;
  for (std::size_t i = 0; i < kArmJoints; ++i) arm_near[i] = near[joint_of(i)];
  closed_form::Postures postures;
  std::visit([&](const auto& arm) { arm.solve(X, arm_near, postures); }, arm_);
  for (std::size_t k = 0; k < postures.count; ++k) {
    out[k] = JointValues{};
    for (std::size_t i = 0; i < kArmJoints; ++i) {
      // Neighbours share the joints nearer to the base; the arc tangents are half of the whole time.
      const Turn& turn = postures.posture[k][i];
      const bool shared = k > 0 && turn == postures.posture[k - 1][i];
      out[k][joint_of(i)] = shared ? out[k - 1][joint_of(i)] : turn.angle();
    }
    if (free_joint_) out[k][*free_joint_] = near[*free_joint_];
  }
  return postures.count;
}

}  // namespace cellmirror::inverse_kinematics
