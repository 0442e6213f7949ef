// Lists: [[x, y, z], [q1, q2, q3, q4], [cf1, cf4, cf6, cfx], [eax_a .. eax_f]] of a robtarget, [[rax_1 .. rax_6],
// [eax_a .. eax_f]] of a jointtarget, [v_tcp, v_ori, v_leax, v_reax] of speeddata.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "rt_core/base/text.hpp"
#include "rt_core/base/units.hpp"
#include "scripts/programs/rapid/expression_nesting.hpp"

namespace cellmirror::program::rapid {
namespace {

constexpr double kNoAxis = 9e9;                // an axis that the robot does not have
constexpr double kQuaternionTolerance = 0.01;  // of its length: programs write few digits
constexpr std::size_t kAxes = 6;

bool absent(const Scalar& axis) { return axis.constant() && axis.value == kNoAxis; }

}  // namespace

std::optional<Scalar> ExpressionReader::read_scalar(std::string_view what) {
  Scalar scalar;
  if (const std::optional<double> written = lexer_.take_list_value()) {
    scalar.value = *written;
    return scalar;
  }
  const std::optional<Operand> operand = read(Type::num, what);
  if (!operand) return std::nullopt;
  if (!operand->known()) return scalar;
  if (const Value* const value = builder_.constant_value(operand->id)) {
    scalar.value = std::get<double>(*value);
  } else {
    scalar.id = operand->id;
  }
  return scalar;
}

// "[a, b, ...]" with so many values.
bool ExpressionReader::read_scalars(std::vector<Scalar>& to, std::size_t count, std::string_view what) {
  const Token at = lexer_.token();
  if (!expect(Sign::open_list, "[")) return false;
  to.reserve(count);
  for (;;) {
    const std::optional<Scalar> scalar = read_scalar(what);
    if (!scalar) return false;
    if (to.size() <= count) to.push_back(*scalar);
    if (!lexer_.at(Sign::comma)) break;
    lexer_.advance();
  }
  if (!expect(Sign::close_list, "]")) return false;
  if (to.size() == count) return true;
  error(at,
        fmt::format("{} has {} values, but needs {}", what, to.size() > count ? "more" : fmt::format("{}", to.size()),
                    count),
        fmt::format("write {} values in [...]", count));
  return false;
}

std::optional<Operand> ExpressionReader::read_list(Type type) {
  const Nesting nesting(*this);
  if (!nesting.fits()) return std::nullopt;
  return type == Type::robtarget ? read_robtarget() : read_jointtarget();
}

// Positions of axes beside the robot are not those of its TCP.
bool ExpressionReader::check_external_axes(const std::vector<Scalar>& axes, const Token& at) {
  const bool none =
      std::ranges::all_of(axes, [](const Scalar& one) { return absent(one) || (one.constant() && one.value == 0); });
  if (!none)
    error(at, "external axes of a robtarget are not in the subset", "write 9E9 for each, or move them by MoveAbsJ");
  return none;
}

std::optional<Operand> ExpressionReader::read_robtarget() {
  std::vector<Scalar> trans;
  std::vector<Scalar> rot;
  std::vector<Scalar> configuration;
  std::vector<Scalar> external;
  lexer_.advance();
  if (!read_scalars(trans, 3, "the position") || !expect(Sign::comma, ",")) return std::nullopt;
  const Token rot_at = lexer_.token();
  if (!read_scalars(rot, 4, "the orientation") || !expect(Sign::comma, ",")) return std::nullopt;
  const Token configuration_at = lexer_.token();
  if (!read_scalars(configuration, 4, "the configuration") || !expect(Sign::comma, ",")) return std::nullopt;
  const Token external_at = lexer_.token();
  if (!read_scalars(external, kAxes, "the list of external axes") || !expect(Sign::close_list, "]"))
    return std::nullopt;
  if (!check_external_axes(external, external_at)) return Operand{};
  if (!std::ranges::all_of(configuration, [](const Scalar& one) { return one.constant() && one.value == 0; })) {
    warn_once(told_configuration_, configuration_at,
              "axis configurations of robtargets have no effect: the joints nearest to those before are taken",
              "begin with a MoveAbsJ that is in the configuration wanted");
  }
  return make_pose(trans, rot, rot_at);
}

ExpressionId ExpressionReader::expression(const Scalar& scalar, double factor) {
  if (scalar.constant()) return builder_.real(scalar.value * factor);
  const Operand product = scaled(Operand{Type::num, scalar.id}, factor, lexer_.token());
  return product.id;
}

Operand ExpressionReader::make_pose(const std::vector<Scalar>& trans, const std::vector<Scalar>& rot, const Token& at) {
  if (!std::ranges::all_of(rot, &Scalar::constant)) {
    error(at, "an orientation has to be constant", "declare robtargets with the orientations that are needed");
    return Operand{};
  }
  const Eigen::Quaterniond quaternion(rot[0].value, rot[1].value, rot[2].value, rot[3].value);  // q1 is the real part
  const double length = quaternion.norm();
  if (!(std::abs(length - 1) <= kQuaternionTolerance)) {
    error(at, fmt::format("the orientation has the length {:.6g} instead of 1", length),
          "write q1, q2, q3, q4 of a unit quaternion, q1 the real part");
    return Operand{};
  }
  const Eigen::Matrix3d R = quaternion.normalized().toRotationMatrix();
  if (std::ranges::all_of(trans, &Scalar::constant)) {
    Pose pose = Pose::Identity();
    pose.linear() = R;
    pose.translation() = kMPerMm * Eigen::Vector3d(trans[0].value, trans[1].value, trans[2].value);
    return Operand{Type::robtarget, builder_.constant(pose)};
  }
  const Eigen::Vector3d rpy = rpy_from_rotation(R);
  const std::array<ExpressionId, 3> position = {expression(trans[0], kMPerMm), expression(trans[1], kMPerMm),
                                                expression(trans[2], kMPerMm)};
  if (std::ranges::find(position, kNoExpression) != position.end()) return Operand{};
  return combine(
      Operator::make_pose, Type::robtarget,
      {position[0], position[1], position[2], builder_.real(rpy.x()), builder_.real(rpy.y()), builder_.real(rpy.z())},
      at);
}

// The joints of the robot are rax_1 .. rax_6, eax_a .. eax_f, up to the first that it does not have.
std::optional<Operand> ExpressionReader::read_jointtarget() {
  const Token at = lexer_.token();
  std::vector<Scalar> axes;
  std::vector<Scalar> external;
  lexer_.advance();
  if (!read_scalars(axes, kAxes, "the list of axes") || !expect(Sign::comma, ",")) return std::nullopt;
  if (!read_scalars(external, kAxes, "the list of external axes") || !expect(Sign::close_list, "]"))
    return std::nullopt;
  axes.insert(axes.end(), external.begin(), external.end());
  const auto end = std::ranges::find_if(axes, &absent);
  if (end == axes.begin() || !std::all_of(end, axes.end(), &absent)) {
    error(at, end == axes.begin() ? "the jointtarget has no axis" : "an axis follows one that the robot does not have",
          "write 9E9 only for the last axes of the jointtarget");
    return Operand{};
  }
  axes.erase(end, axes.end());
  JointPosition position;
  position.count = static_cast<std::uint8_t>(axes.size());
  position.units = JointUnits::degree_mm;
  for (std::size_t i = 0; i < axes.size(); ++i) position.values.at(i) = axes[i].value;
  if (std::ranges::all_of(axes, &Scalar::constant)) return Operand{Type::jointtarget, builder_.constant(position)};
  std::vector<ExpressionId> ids;
  for (const Scalar& axis : axes) ids.push_back(expression(axis, 1));
  const Result<ExpressionId> made =
      builder_.operation(Operator::make_joints, ids, static_cast<std::uint32_t>(JointUnits::degree_mm));
  if (made) return Operand{Type::jointtarget, *made};
  error(at, made.error());
  return Operand{};
}

std::optional<Speed> ExpressionReader::read_speed(bool& known) {
  const Token at = lexer_.token();
  known = false;
  if (at.sign == Sign::open_list) {
    std::vector<Scalar> values;
    if (!read_scalars(values, 4, "speeddata")) return std::nullopt;
    const bool valid = std::ranges::all_of(values, &Scalar::constant) && values[0].value > 0 && values[1].value > 0;
    if (!valid) error(at, "the velocities of speeddata have to be constant and above 0", "write mm/s and degrees/s");
    known = valid;
    return Speed{values[0].value, values[1].value};
  }
  if (at.kind != TokenKind::word) {
    error(at, fmt::format("a speed is missing before {}", shown(at)), "write v100, or the name of speeddata");
    return std::nullopt;
  }
  lexer_.advance();
  const Declared* declared = names_.find(at.text);
  if (declared == nullptr) {
    const std::optional<Speed> speed = predefined_speed(at.text);
    known = speed.has_value();
    if (speed) return speed;
    error(at, fmt::format("there is no speed {}", shown(at)), "write v5 .. v7000 or vmax, or declare it as speeddata");
    names_.forgive(at.text);
  }
  if (declared == nullptr || declared->storage == Declared::Storage::unusable) return Speed{};
  known = declared->type == Type::speeddata;
  if (!known) wrong_type(at, "the speed of a move", "speeddata", Operand{declared->type});
  return declared->speed;
}

}  // namespace cellmirror::program::rapid
