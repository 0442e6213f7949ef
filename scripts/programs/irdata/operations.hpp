// The operations of records: their symbolic names and parameters. Their numeric codes are in a table that the user may
// replace (code_table.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace cellmirror::program::irdata {

enum class Operation : std::uint8_t {
  // header section
  header,
  author,
  date,
  robot,
  version,
  end_header,
  boolean,
  integer,
  real,
  pose,
  joints,
  constant,
  list,
  data,
  semaphore,
  // motion: three of each kind of target, in the order of PathKind
  ptp,
  lin,
  cir,
  ptp_inc,
  lin_inc,
  cir_inc,
  ptp_tool,
  lin_tool,
  cir_tool,
  // offsets and settings
  tcp,
  zero_point,
  vel_joint,
  acc_joint,
  vel_lin,
  acc_lin,
  vel_rot,
  acc_rot,
  fly,
  // program flow
  label,
  jump,
  jump_if,
  jump_on,
  if_begin,
  else_if,
  else_part,
  end_if,
  while_begin,
  end_while,
  repeat,
  until,
  for_begin,
  end_for,
  loop,
  end_loop,
  exit_loop,
  call,
  subprogram,
  end_subprogram,
  return_back,
  pause,
  stop,
  end,
  // arithmetic
  set,
  inc,
  dec,
  add,
  sub,
  mul,
  div,
  idiv,
  mod,
  pow,
  min,
  max,
  atan2,
  logical_and,
  logical_or,
  logical_xor,
  compose,
  neg,
  abs,
  sqrt,
  sin,
  cos,
  tan,
  asin,
  acos,
  round,
  trunc,
  logical_not,
  invert,
  shift,
  get_pose,
  get_joints,
  // inputs and outputs, waiting, semaphores, comments
  din,
  ain,
  dout,
  aout,
  pulse,
  wait_time,
  wait_input,
  wait_until,
  acquire,
  release,
  comment,
};
inline constexpr std::size_t kOperations = static_cast<std::size_t>(Operation::comment) + 1;

enum class OperationGroup : std::uint8_t { header, declaration, motion, setting, flow, arithmetic, signal, comment };

struct OperationRow {
  Operation operation;
  OperationGroup group;
  std::string_view name;        // upper case
  std::string_view parameters;  // as they are written, for messages: "target [, FLY]"
};

// In the order of Operation.
[[nodiscard]] std::span<const OperationRow> operations();
[[nodiscard]] const OperationRow& row_of(Operation operation);
// By symbolic name, without regard to case.
[[nodiscard]] std::optional<Operation> find_operation(std::string_view name);
// "PTP, target [, FLY]": what is written behind a record's number.
[[nodiscard]] std::string form_of(Operation operation);
// "did you mean PTP or LIN?", or empty.
[[nodiscard]] std::string nearest_operation(std::string_view wrong);

}  // namespace cellmirror::program::irdata
