#include "scripts/programs/irdata/operations.hpp"

#include <array>
#include <vector>

#include "rt_core/base/text.hpp"
#include "scripts/programs/irdata/words.hpp"

namespace cellmirror::program::irdata {

namespace {

using enum OperationGroup;

constexpr std::array<OperationRow, kOperations> kRows = {{
    {Operation::header, header, "HEADER", "name of the program"},
    {Operation::author, header, "AUTHOR", "text"},
    {Operation::date, header, "DATE", "text"},
    {Operation::robot, header, "ROBOT", "text"},
    {Operation::version, header, "VERSION", "text"},
    {Operation::end_header, header, "END_HEADER", ""},
    {Operation::boolean, declaration, "BOOLEAN", "name [, value]"},
    {Operation::integer, declaration, "INTEGER", "name [, value]"},
    {Operation::real, declaration, "REAL", "name [, value]"},
    {Operation::pose, declaration, "POSE", "name [, POSE(x, y, z, roll, pitch, yaw)]"},
    {Operation::joints, declaration, "JOINTS", "name [, JOINTS(value of joint 1, ...)]"},
    {Operation::constant, declaration, "CONSTANT", "name, value"},
    {Operation::list, declaration, "LIST", "name, type [, first index, last index]"},
    {Operation::data, declaration, "DATA", "name of a list, value, ..."},
    {Operation::semaphore, declaration, "SEMAPHORE", "name [, initial count]"},
    {Operation::ptp, motion, "PTP", "target [, FLY]"},
    {Operation::lin, motion, "LIN", "target [, FLY]"},
    {Operation::cir, motion, "CIR", "via point, target [, FLY]"},
    {Operation::ptp_inc, motion, "PTP_INC", "difference [, FLY]"},
    {Operation::lin_inc, motion, "LIN_INC", "difference [, FLY]"},
    {Operation::cir_inc, motion, "CIR_INC", "difference to the via point, difference to the target [, FLY]"},
    {Operation::ptp_tool, motion, "PTP_TOOL", "difference along the axes of the TCP [, FLY]"},
    {Operation::lin_tool, motion, "LIN_TOOL", "difference along the axes of the TCP [, FLY]"},
    {Operation::cir_tool, motion, "CIR_TOOL", "difference to the via point, difference to the target [, FLY]"},
    {Operation::tcp, setting, "TCP", "pose of the TCP in the point of reference, or DEFAULT"},
    {Operation::zero_point, setting, "ZERO_POINT", "pose of the zero point, or DEFAULT"},
    {Operation::vel_joint, setting, "VEL_JOINT", "percent of the joints' greatest velocities, or DEFAULT"},
    {Operation::acc_joint, setting, "ACC_JOINT", "percent of the joints' greatest accelerations, or DEFAULT"},
    {Operation::vel_lin, setting, "VEL_LIN", "mm/s, or DEFAULT"},
    {Operation::acc_lin, setting, "ACC_LIN", "mm/s2, or DEFAULT"},
    {Operation::vel_rot, setting, "VEL_ROT", "degrees/s, or DEFAULT"},
    {Operation::acc_rot, setting, "ACC_ROT", "degrees/s2, or DEFAULT"},
    {Operation::fly, setting, "FLY", "SPEED, percent | DISTANCE, mm | ANGLE, degrees | DEFAULT"},
    {Operation::label, flow, "LABEL", "name"},
    {Operation::jump, flow, "JUMP", "label or record number"},
    {Operation::jump_if, flow, "JUMP_IF", "condition, label or record number"},
    {Operation::jump_on, flow, "JUMP_ON", "integer, label for 1, label for 2, ..."},
    {Operation::if_begin, flow, "IF", "condition"},
    {Operation::else_if, flow, "ELSE_IF", "condition"},
    {Operation::else_part, flow, "ELSE", ""},
    {Operation::end_if, flow, "END_IF", ""},
    {Operation::while_begin, flow, "WHILE", "condition"},
    {Operation::end_while, flow, "END_WHILE", ""},
    {Operation::repeat, flow, "REPEAT", ""},
    {Operation::until, flow, "UNTIL", "condition"},
    {Operation::for_begin, flow, "FOR", "integer variable, first, last [, step]"},
    {Operation::end_for, flow, "END_FOR", ""},
    {Operation::loop, flow, "LOOP", "[how often]"},
    {Operation::end_loop, flow, "END_LOOP", ""},
    {Operation::exit_loop, flow, "EXIT_LOOP", ""},
    {Operation::call, flow, "CALL", "name of a subprogram"},
    {Operation::subprogram, flow, "SUBPROGRAM", "name"},
    {Operation::end_subprogram, flow, "END_SUBPROGRAM", ""},
    {Operation::return_back, flow, "RETURN", ""},
    {Operation::pause, flow, "PAUSE", ""},
    {Operation::stop, flow, "STOP", ""},
    {Operation::end, flow, "END", ""},
    {Operation::set, arithmetic, "SET", "variable, value"},
    {Operation::inc, arithmetic, "INC", "variable [, by]"},
    {Operation::dec, arithmetic, "DEC", "variable [, by]"},
    {Operation::add, arithmetic, "ADD", "result, a, b"},
    {Operation::sub, arithmetic, "SUB", "result, a, b"},
    {Operation::mul, arithmetic, "MUL", "result, a, b"},
    {Operation::div, arithmetic, "DIV", "result, a, b"},
    {Operation::idiv, arithmetic, "IDIV", "result, a, b"},
    {Operation::mod, arithmetic, "MOD", "result, a, b"},
    {Operation::pow, arithmetic, "POW", "result, base, exponent"},
    {Operation::min, arithmetic, "MIN", "result, a, b"},
    {Operation::max, arithmetic, "MAX", "result, a, b"},
    {Operation::atan2, arithmetic, "ATAN2", "result, y, x"},
    {Operation::logical_and, arithmetic, "AND", "result, a, b"},
    {Operation::logical_or, arithmetic, "OR", "result, a, b"},
    {Operation::logical_xor, arithmetic, "XOR", "result, a, b"},
    {Operation::compose, arithmetic, "COMPOSE", "result, pose, pose in the axes of the first"},
    {Operation::neg, arithmetic, "NEG", "result, a"},
    {Operation::abs, arithmetic, "ABS", "result, a"},
    {Operation::sqrt, arithmetic, "SQRT", "result, a"},
    {Operation::sin, arithmetic, "SIN", "result, degrees"},
    {Operation::cos, arithmetic, "COS", "result, degrees"},
    {Operation::tan, arithmetic, "TAN", "result, degrees"},
    {Operation::asin, arithmetic, "ASIN", "result, a"},
    {Operation::acos, arithmetic, "ACOS", "result, a"},
    {Operation::round, arithmetic, "ROUND", "result, a"},
    {Operation::trunc, arithmetic, "TRUNC", "result, a"},
    {Operation::logical_not, arithmetic, "NOT", "result, a"},
    {Operation::invert, arithmetic, "INVERT", "result, pose"},
    {Operation::shift, arithmetic, "SHIFT", "pose variable, x, y, z"},
    {Operation::get_pose, arithmetic, "GET_POSE", "pose variable"},
    {Operation::get_joints, arithmetic, "GET_JOINTS", "variable for joints"},
    {Operation::din, signal, "DIN", "result, number of the input"},
    {Operation::ain, signal, "AIN", "result, number of the input"},
    {Operation::dout, signal, "DOUT", "number of the output, ON or OFF"},
    {Operation::aout, signal, "AOUT", "number of the output, value"},
    {Operation::pulse, signal, "PULSE", "number of the output, seconds"},
    {Operation::wait_time, signal, "WAIT_TIME", "seconds"},
    {Operation::wait_input, signal, "WAIT_INPUT", "number of the input, ON or OFF [, seconds [, label]]"},
    {Operation::wait_until, signal, "WAIT_UNTIL", "condition [, seconds [, label]]"},
    {Operation::acquire, signal, "ACQUIRE", "semaphore"},
    {Operation::release, signal, "RELEASE", "semaphore"},
    {Operation::comment, comment, "COMMENT", "text"},
}};

constexpr bool rows_are_in_order() {
  for (std::size_t i = 0; i < kRows.size(); ++i)
    if (kRows[i].operation != static_cast<Operation>(i)) return false;
  return true;
}
static_assert(rows_are_in_order());

constexpr std::array<std::string_view, kOperations> collect_operation_names() {
  std::array<std::string_view, kOperations> names;
  for (std::size_t i = 0; i < kRows.size(); ++i) names[i] = kRows[i].name;
  return names;
}
constexpr std::array<std::string_view, kOperations> kOperationNames = collect_operation_names();

}  // namespace

std::span<const OperationRow> operations() { return kRows; }

const OperationRow& row_of(Operation operation) { return kRows[static_cast<std::size_t>(operation)]; }

std::optional<Operation> find_operation(std::string_view name) {
  static const WordTable table{kOperationNames};
  const std::size_t index = table.find(name);
  if (index == WordTable::kNone) return std::nullopt;
  return static_cast<Operation>(index);
}

std::string form_of(Operation operation) {
  const OperationRow& row = row_of(operation);
  std::string form(row.name);
  if (row.parameters.empty()) return form;
  return form + (row.parameters.starts_with('[') ? " [, " + std::string(row.parameters.substr(1))
                                                 : ", " + std::string(row.parameters));
}

std::string nearest_operation(std::string_view wrong) {
  static const std::vector<std::string> names(kOperationNames.begin(), kOperationNames.end());
  return did_you_mean(wrong, names);
}

}  // namespace cellmirror::program::irdata
