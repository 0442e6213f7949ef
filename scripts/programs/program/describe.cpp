#include "scripts/programs/program/describe.hpp"

#include <fmt/format.h>

namespace cellmirror::program {
namespace {

constexpr std::size_t kLongest = 120;  // bytes

std::string value_text(const Value& value) {
  if (const auto* boolean = std::get_if<bool>(&value)) return *boolean ? "true" : "false";
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *integer);
  if (const auto* real = std::get_if<double>(&value)) return fmt::format("{:g}", *real);
  return std::string(name_of(type_of(value)));
}

bool infix(Operator which) {
  switch (which) {
    case Operator::add:
    case Operator::subtract:
    case Operator::multiply:
    case Operator::divide:
    case Operator::integer_divide:
    case Operator::modulo:
    case Operator::compose:
      return true;
    default:
      return which >= Operator::equal && which <= Operator::logical_xor;
  }
}

void write(const Program& program, ExpressionId id, bool within, std::string& out) {
  if (out.size() > kLongest) return;
  const ExpressionNode& node = program.expressions[id];
  const auto operand = [&](std::size_t index) { return program.operands[node.first_operand + index]; };
  if (node.which == Operator::constant) {
    out += value_text(program.constants[node.payload]);
  } else if (node.which == Operator::variable) {
    out += program.variables[node.payload].name;
  } else if (node.which == Operator::element) {
    out += program.variables[node.payload].name + "[";
    write(program, operand(0), false, out);
    out += "]";
  } else if (infix(node.which)) {
    if (within) out += "(";
    write(program, operand(0), true, out);
    out += fmt::format(" {} ", name_of(node.which));
    write(program, operand(1), true, out);
    if (within) out += ")";
  } else if (node.which == Operator::logical_not || reads_world(node.which)) {
    out += name_of(node.which);
    if (node.operands == 0) return;
    out += " ";
    write(program, operand(0), true, out);
  } else {
    out += fmt::format("{}(", name_of(node.which));
    for (std::size_t index = 0; index < node.operands; ++index) {
      if (index > 0) out += ", ";
      write(program, operand(index), false, out);
    }
    out += ")";
  }
}

}  // namespace

std::string describe(const Program& program, ExpressionId id) {
  std::string out;
  if (id < program.expressions.size()) write(program, id, false, out);
  if (out.size() > kLongest) out = out.substr(0, kLongest) + "...";
  return out;
}

}  // namespace cellmirror::program
