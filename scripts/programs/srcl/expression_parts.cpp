// What expressions are made of: numbers, names, functions, poses and joints.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "rt_core/base/text.hpp"
#include "rt_core/base/units.hpp"
#include "scripts/programs/srcl/expressions.hpp"
#include "scripts/programs/srcl/keywords.hpp"

namespace cellmirror::program::srcl {

namespace {

constexpr std::array<std::string_view, 6> kPoseComponents = {"X", "Y", "Z", "ROLL", "NICK", "GIER"};

// mm or degrees to SI.
constexpr double pose_factor(std::size_t component) { return component < 3 ? kMPerMm : kRadPerDeg; }

struct FunctionRow {
  Keyword keyword;
  Operator which;
  std::uint8_t operands;
  enum class Type : std::uint8_t { as_operands, real, integer, pose } result;
  double operand_factor = 1;  // degrees in
  double result_factor = 1;   // degrees out
};

constexpr double kDegPerRad = 1 / kRadPerDeg;
using FunctionType = FunctionRow::Type;
constexpr auto kFunctions = std::to_array<FunctionRow>({
    {Keyword::absolute, Operator::absolute, 1, FunctionType::as_operands},
    {Keyword::square_root, Operator::square_root, 1, FunctionType::real},
    {Keyword::sine, Operator::sine, 1, FunctionType::real, kRadPerDeg},
    {Keyword::cosine, Operator::cosine, 1, FunctionType::real, kRadPerDeg},
    {Keyword::tangent, Operator::tangent, 1, FunctionType::real, kRadPerDeg},
    {Keyword::arc_sine, Operator::arc_sine, 1, FunctionType::real, 1, kDegPerRad},
    {Keyword::arc_cosine, Operator::arc_cosine, 1, FunctionType::real, 1, kDegPerRad},
    {Keyword::arc_tangent, Operator::arc_tangent, 2, FunctionType::real, 1, kDegPerRad},
    {Keyword::minimum, Operator::minimum, 2, FunctionType::as_operands},
    {Keyword::maximum, Operator::maximum, 2, FunctionType::as_operands},
    {Keyword::round, Operator::round, 1, FunctionType::integer},
    {Keyword::truncate, Operator::truncate, 1, FunctionType::integer},
    {Keyword::real, Operator::to_real, 1, FunctionType::real},
    {Keyword::inverse, Operator::inverse, 1, FunctionType::pose},
});

}  // namespace

std::optional<Component> ExpressionReader::read_component(ValueType type) {
  const Token dot = lexer_.token();
  lexer_.advance();
  const Token name = lexer_.token();
  const bool word = name.kind == TokenKind::name || name.kind == TokenKind::keyword;
  if (type != ValueType::pose && type != ValueType::joints) {
    faults_.add(dot, fmt::format("a value of {} has no components", word_of(type)));
    return std::nullopt;
  }
  if (word && type == ValueType::pose) {
    for (std::size_t i = 0; i < kPoseComponents.size(); ++i) {
      if (!equal_ignoring_case(name.text, kPoseComponents[i])) continue;
      lexer_.advance();
      return Component{static_cast<std::uint32_t>(i), pose_factor(i)};
    }
  }
  if (word && type == ValueType::joints && (name.text.front() == 'A' || name.text.front() == 'a')) {
    const auto axis = parse_integer(name.text.substr(1));
    const bool plain = axis && fmt::format("{}", *axis) == name.text.substr(1);
    if (plain && *axis >= 1 && *axis <= static_cast<long long>(kMaxJointsPerRobot)) {
      lexer_.advance();
      return Component{static_cast<std::uint32_t>(*axis - 1), 1};
    }
  }
  faults_.add(name, fmt::format("{} is not a component of a value of {}", shown(name), word_of(type)),
              type == ValueType::pose ? "they are X, Y, Z, ROLL, NICK and GIER"
                                      : fmt::format("they are A1 to A{}", kMaxJointsPerRobot));
  return std::nullopt;
}

std::optional<Operand> ExpressionReader::primary() {
  const Token token = lexer_.token();
  switch (token.kind) {
    case TokenKind::integer:
      lexer_.advance();
      return Operand::of(token.integer);
    case TokenKind::real:
      lexer_.advance();
      return Operand::of(token.real);
    case TokenKind::bad_number:
      faults_.add(token, fmt::format("{} is not a representable number", shown(token)),
                  "write a number like 12, 0.5 or 1.5E3");
      return std::nullopt;
    case TokenKind::name:
      return named();
    case TokenKind::keyword:
      return world_or_constant(token.keyword);
    case TokenKind::sign:
      if (token.sign == Sign::open) {
        lexer_.advance();
        const std::optional<Operand> inner = read();
        if (!inner || !expect(Sign::close, ")")) return std::nullopt;
        return inner;
      }
      [[fallthrough]];
    default:
      faults_.add(token, fmt::format("a value is missing before {}", shown(token)),
                  "write a number, a name or an expression");
      return std::nullopt;
  }
}

std::optional<Operand> ExpressionReader::named() {
  const Token name = lexer_.token();
  const Declared* const declared = find(name);
  lexer_.advance();
  if (declared == nullptr) {
    if (lexer_.token().sign != Sign::open) return Operand{};
    std::array<Operand, kMaxJointsPerRobot> ignored{};  // it was meant as an element or a function
    if (!arguments(ignored, 1, name)) return std::nullopt;
    return Operand{};
  }
  Operand operand;
  operand.form = Operand::Form::node;
  operand.type = declared->type;
  switch (declared->kind) {
    case Declared::Kind::variable:
      if (lexer_.token().sign == Sign::open) {
        report_no_list(name);
        return std::nullopt;
      }
      return emitter_.node(Operator::variable, declared->type, {}, declared->variable);
    case Declared::Kind::constant:
      return declared->value;
    case Declared::Kind::list: {
      const std::optional<Operand> index = read_index(*declared);
      if (!index || !index->known()) return index;
      return emitter_.node(Operator::element, declared->type, {*index}, declared->variable);
    }
    case Declared::Kind::semaphore:
      faults_.add(name, fmt::format("{} is a semaphore and has no value", shown(name)), "use BELEGE or FREI with it");
      return Operand{};
  }
  return operand;
}

void ExpressionReader::report_no_list(const Token& name) {
  faults_.add(lexer_.token(), fmt::format("{} is not a list", shown(name)),
              "delete the index, or declare it with LISTE");
}

std::optional<Operand> ExpressionReader::read_index(const Declared& list) {
  if (lexer_.token().sign != Sign::open) {
    faults_.add(lexer_.token(), fmt::format("the index of a list is missing before {}", shown(lexer_.token())),
                fmt::format("write an index from {} to {}, as in ({})", list.first, list.last, list.first));
    return std::nullopt;
  }
  lexer_.advance();
  const Token at = lexer_.token();
  std::optional<Operand> index = read(ValueType::integer, "the index");
  if (!index || !expect(Sign::close, ")")) return std::nullopt;
  if (index->form == Operand::Form::integer && (index->integer < list.first || index->integer > list.last)) {
    faults_.add(at, fmt::format("the list has no element {}", index->integer),
                fmt::format("its elements are {} to {}", list.first, list.last));
    return Operand{};
  }
  return index;
}

std::optional<Operand> ExpressionReader::read_port() {
  if (!expect(Sign::open, "(")) return std::nullopt;
  const Token at = lexer_.token();
  std::optional<Operand> number = read(ValueType::integer, "the number of an input or output");
  if (!number || !expect(Sign::close, ")")) return std::nullopt;
  if (number->form == Operand::Form::integer &&
      (number->integer < 1 || number->integer > static_cast<std::int64_t>(kMostPorts))) {
    faults_.add(at, fmt::format("there is no input or output {}", number->integer),
                fmt::format("they are numbered from 1 to {}", kMostPorts));
    return Operand{};
  }
  return number;
}

std::optional<Operand> ExpressionReader::world_or_constant(Keyword keyword) {
  const auto port = [this](Operator which, ValueType type) -> std::optional<Operand> {
    lexer_.advance();
    const std::optional<Operand> number = read_port();
    if (!number || !number->known()) return number;
    return emitter_.node(which, type, {*number});
  };
  const auto value = [this](const Operand& operand) {
    lexer_.advance();
    return operand;
  };
  switch (keyword) {
    case Keyword::true_value:
      return value(Operand::of(true));
    case Keyword::false_value:
      return value(Operand::of(false));
    case Keyword::pi:
      return value(Operand::of(std::numbers::pi));
    case Keyword::current_pose:
      return value(emitter_.node(Operator::current_position, ValueType::pose, {}));
    case Keyword::current_joints:
      return value(emitter_.node(Operator::current_joints, ValueType::joints, {},
                                 static_cast<std::uint32_t>(JointUnits::degree_mm)));
    case Keyword::digital_input:
      return port(Operator::digital_input, ValueType::boolean);
    case Keyword::digital_output:
      return port(Operator::digital_output, ValueType::boolean);
    case Keyword::analogue_input:
      return port(Operator::analogue_input, ValueType::real);
    case Keyword::analogue_output:
      return port(Operator::analogue_output, ValueType::real);
    case Keyword::pose:
      return make_pose();
    case Keyword::joints:
      return make_joints();
    default:
      return function();
  }
}

// "(a, b)": how many were read; at most as many as there is room for.
std::optional<std::size_t> ExpressionReader::arguments(std::span<Operand> to, std::size_t least,
                                                       const Token& function) {
  if (!expect(Sign::open, "(")) return std::nullopt;
  std::size_t count = 0;
  for (;;) {
    if (count == to.size()) {
      faults_.add(lexer_.token(),
                  fmt::format("{} takes at most {} value{}", shown(function), to.size(), to.size() == 1 ? "" : "s"),
                  "write ')' before the comma");
      return std::nullopt;
    }
    const std::optional<Operand> argument = read();
    if (!argument) return std::nullopt;
    to[count++] = *argument;
    if (lexer_.token().sign != Sign::comma) break;
    lexer_.advance();
  }
  if (!expect(Sign::close, ")")) return std::nullopt;
  if (count < least) {
    faults_.add(function, fmt::format("{} takes {} values, but has {}", shown(function), least, count),
                "write the missing ones");
    for (Operand& operand : to) operand = Operand{};
  }
  return count;
}

std::optional<Operand> ExpressionReader::function() {
  const Token name = lexer_.token();
  const auto* const row = std::ranges::find(kFunctions, name.keyword, &FunctionRow::keyword);
  if (row == kFunctions.end()) {
    faults_.add(name, fmt::format("{} is not allowed in an expression", shown(name)),
                "write a number, a name or a function; names must differ from keywords");
    return std::nullopt;
  }
  lexer_.advance();
  std::array<Operand, 2> buffer{};
  const std::span<Operand> operands = std::span(buffer).first(row->operands);
  if (!arguments(operands, row->operands, name)) return std::nullopt;
  if (!std::ranges::all_of(operands, &Operand::known)) return Operand{};
  if (row->result == FunctionType::pose) {
    if (!operands[0].is(ValueType::pose)) {
      faults_.add(name, fmt::format("{} takes a value of LAGE, but this is {}", shown(name), word_of(operands[0].type)),
                  "write a pose");
      return Operand{};
    }
    return combine(row->which, ValueType::pose, operands, name);
  }
  for (const Operand& operand : operands) {
    if (!operand.number()) return wrong_type(name, shown(name), "numbers", operand);
  }
  const bool mixed = operands.size() == 2 && operands[0].type != operands[1].type;
  if (row->result == FunctionType::real || mixed) {
    for (Operand& operand : operands) operand = emitter_.real(operand, row->operand_factor);
  }
  ValueType type = operands[0].type;
  if (row->result == FunctionType::integer) type = ValueType::integer;
  if (row->which == Operator::to_real) return operands[0];
  const Operand result = combine(row->which, type, operands, name);
  return row->result_factor == 1 ? result : emitter_.real(result, row->result_factor);
}

std::optional<Operand> ExpressionReader::make_pose() {
  const Token name = lexer_.token();
  lexer_.advance();
  std::array<Operand, 6> buffer{};
  const std::optional<std::size_t> count = arguments(buffer, 3, name);
  if (!count) return std::nullopt;
  if (*count > 3 && *count < 6) {
    faults_.add(name, fmt::format("LAGE takes 3 or 6 values, but has {}", *count),
                "write LAGE(x, y, z) or LAGE(x, y, z, roll, nick, gier)");
    return Operand{};
  }
  for (std::size_t i = *count; i < buffer.size(); ++i) {
    if (*count == 3) buffer[i] = Operand::of(0.0);
  }
  bool constant = true;
  for (std::size_t i = 0; i < buffer.size(); ++i) {
    if (!buffer[i].known()) return Operand{};
    if (!buffer[i].number()) return wrong_type(name, "LAGE", "numbers", buffer[i]);
    constant = constant && buffer[i].constant();
  }
  for (std::size_t i = 0; i < buffer.size(); ++i) buffer[i] = emitter_.real(buffer[i], pose_factor(i));
  if (!constant) return combine(Operator::make_pose, ValueType::pose, buffer, name);
  const auto value = [&buffer](std::size_t i) { return buffer[i].real; };
  return emitter_.stored(pose_from_xyz_rpy({value(0), value(1), value(2)}, {value(3), value(4), value(5)}));
}

std::optional<Operand> ExpressionReader::make_joints() {
  const Token name = lexer_.token();
  lexer_.advance();
  std::array<Operand, kMaxJointsPerRobot> buffer{};
  const std::optional<std::size_t> count = arguments(buffer, 1, name);
  if (!count) return std::nullopt;
  const std::span<Operand> operands = std::span(buffer).first(*count);
  JointPosition position;
  position.units = JointUnits::degree_mm;
  position.count = static_cast<std::uint8_t>(*count);
  bool constant = true;
  for (std::size_t i = 0; i < operands.size(); ++i) {
    if (!operands[i].known()) return Operand{};
    if (!operands[i].number()) return wrong_type(name, "STELLUNG", "numbers", operands[i]);
    constant = constant && operands[i].constant();
    operands[i] = emitter_.real(operands[i]);
    position.values[i] = operands[i].real;
  }
  if (constant) return emitter_.stored(position);
  return combine(Operator::make_joints, ValueType::joints, operands, name,
                 static_cast<std::uint32_t>(JointUnits::degree_mm));
}

}  // namespace cellmirror::program::srcl
