// Names and calls within expressions.
#include <fmt/format.h>

#include <array>

#include "rt_core/base/text.hpp"
#include "rt_core/base/units.hpp"
#include "scripts/programs/irdata/expression_reader.hpp"

namespace cellmirror::program::irdata {

Term ExpressionReader::word(Word which, std::string_view text, std::uint32_t column) {
  switch (which) {
    case Word::on:
    case Word::true_word:
      return terms_.value(true, column);
    case Word::off:
    case Word::false_word:
      return terms_.value(false, column);
    case Word::pi:
      return real_literal(std::numbers::pi, column);
    case Word::pose:
      return make_pose(column);
    case Word::joints:
      return make_joints(column);
    case Word::here:
      return terms_.apply(Operator::current_position, column, {});
    case Word::here_joints:
      return terms_.apply(Operator::current_joints, column, {}, static_cast<std::uint32_t>(JointUnits::degree_mm));
    case Word::din:
      return port(Operator::digital_input, text, column);
    case Word::ain:
      return port(Operator::analogue_input, text, column);
    case Word::dout:
      return port(Operator::digital_output, text, column);
    case Word::aout:
      return port(Operator::analogue_output, text, column);
    case Word::first:
    case Word::last:
    case Word::length:
      return list_bound(which, column);
    default:
      break;
  }
  if (const FunctionRow* row = find_function(which)) return call(*row, text, column);
  return syntax_error(column, fmt::format("'{}' is not a value", text),
                      "it is a reserved word; write a number, a name or an expression");
}

Term ExpressionReader::symbol(std::string_view name, std::uint32_t column) {
  const Symbol* symbol = known_symbol(name, column);
  Term unknown;
  unknown.column = column;
  cursor_->skip_blank();
  if (symbol == nullptr || symbol->kind == Symbol::Kind::unknown) {
    if (cursor_->peek() == '[') static_cast<void>(list_index());
    if (cursor_->peek() == '(')
      return syntax_error(cursor_->column(), fmt::format("'{}' is not a function", printable(name, 40)),
                          "see docs/languages/irdata.md for the list of functions");
    return unknown;
  }
  if (symbol->kind == Symbol::Kind::constant) {
    const Value& value = symbols_.constants[symbol->detail];
    if (const auto* integer = std::get_if<std::int64_t>(&value)) return integer_literal(*integer, column);
    if (const auto* real = std::get_if<double>(&value)) return real_literal(*real, column);
    return terms_.value(value, column);
  }
  if (header_) {
    terms_.findings().error(column, fmt::format("'{}' has no value in the header section", name),
                            "write a number or a CONSTANT, and SET the variable after END_HEADER");
    if (cursor_->peek() == '[') static_cast<void>(list_index());
    return unknown;
  }
  if (symbol->kind == Symbol::Kind::variable) {
    if (cursor_->peek() == '[') {
      terms_.findings().error(cursor_->column(), fmt::format("'{}' is not a list", name), "remove the index");
      static_cast<void>(list_index());
      return unknown;
    }
    return terms_.variable(symbol->variable, column);
  }
  if (cursor_->peek() != '[') {
    terms_.findings().error(column, fmt::format("'{}' is a list", name), fmt::format("write {}[index]", name));
    return unknown;
  }
  const Term index = list_index();
  if (!index.known || !has_element(symbol->variable, index)) return unknown;
  return terms_.apply(Operator::element, column, {index}, symbol->variable);
}

// "[index]"; an integer.
Term ExpressionReader::list_index() {
  cursor_->skip();
  const Term index = binary(1);
  if (failed_) return index;
  if (!cursor_->take(']')) return syntax_error(cursor_->column(), "a ']' is missing", "close the bracket of the index");
  if (index.known && index.type != ValueType::integer) {
    terms_.findings().error(index.column,
                            fmt::format("an index must be an integer, this is {}", with_article(index.type)),
                            "use ROUND or TRUNC");
    return Term{};
  }
  return index;
}

bool ExpressionReader::has_element(VariableId list, const Term& index) {
  const std::optional<Value> value = terms_.constant(index);
  const auto* number = value ? std::get_if<std::int64_t>(&*value) : nullptr;
  if (number == nullptr || list == kNone) return true;  // too many variables have been reported
  const Variable& variable = terms_.builder().variable_of(list);
  const std::int64_t last = variable.first + static_cast<std::int64_t>(variable.initial.size()) - 1;
  if (*number >= variable.first && *number <= last) return true;
  terms_.findings().error(index.column, fmt::format("'{}' has no element {}", variable.name, *number),
                          fmt::format("its elements are {} to {}", variable.first, last));
  return false;
}

const Symbol* ExpressionReader::known_symbol(std::string_view name, std::uint32_t column) {
  if (const Symbol* symbol = symbols_.find(name)) return symbol;
  undeclared(name, column);
  return nullptr;
}

void ExpressionReader::undeclared(std::string_view name, std::uint32_t column) {
  std::string remedy = "declare it in the header section";
  if (terms_.findings().may_suggest()) {
    const std::string near = did_you_mean(name, symbols_.names(1000));
    if (!near.empty()) remedy = near + " Or " + remedy;
  }
  terms_.findings().error(column, fmt::format("'{}' is not declared", printable(name, 40)), remedy);
  symbols_.add(name, Symbol{});
}

std::optional<std::size_t> ExpressionReader::arguments(std::string_view function, std::uint32_t column,
                                                       std::size_t fewest, std::size_t most) {
  const std::size_t begin = arguments_.size();
  if (!cursor_->take('(')) {
    syntax_error(cursor_->column(), fmt::format("a '(' is missing after {}", function), "put its values in brackets");
    return std::nullopt;
  }
  bool more = !cursor_->take(')');
  while (more) {
    const Term argument = value();
    if (failed_) break;
    if (arguments_.size() - begin < most + 1) arguments_.push_back(argument);
    more = cursor_->take(',');
    if (!more && !cursor_->take(')')) {
      syntax_error(cursor_->column(), fmt::format("a ')' is missing after the values of {}", function),
                   "close the bracket");
      break;
    }
  }
  const std::size_t count = arguments_.size() - begin;
  if (!failed_ && (count < fewest || count > most))
    terms_.findings().error(
        column,
        count < fewest ? fmt::format("{} has {} {}", function, count, count == 1 ? "value" : "values")
                       : fmt::format("{} has more than {} {}", function, most, most == 1 ? "value" : "values"),
        fewest == most ? fmt::format("write {}", fewest) : fmt::format("write {} to {}", fewest, most));
  if (!failed_ && count >= fewest && count <= most) return begin;
  arguments_.resize(begin);
  return std::nullopt;
}

bool ExpressionReader::are_numbers(std::size_t begin, std::string_view function) {
  bool all = true;
  for (const Term& argument : arguments_from(begin)) {
    if (!argument.known) all = false;
    if (!argument.known || argument.is_number()) continue;
    terms_.findings().error(argument.column,
                            fmt::format("{} takes numbers, this is {}", function, with_article(argument.type)),
                            "write a number here");
    all = false;
  }
  return all;
}

Term ExpressionReader::call(const FunctionRow& row, std::string_view text, std::uint32_t column) {
  Term out;
  out.column = column;
  const auto begin = arguments(text, column, row.arguments, row.arguments);
  if (!begin) return out;
  if (row.takes_degrees) {
    if (are_numbers(*begin, text))
      out = terms_.apply(row.which, column, {terms_.scaled(arguments_[*begin], kRadPerDeg)});
  } else {
    out = terms_.apply(row.which, column, arguments_from(*begin));
  }
  arguments_.resize(*begin);
  if (row.gives_degrees) out = terms_.scaled(out, 1.0 / kRadPerDeg);
  return out;
}

Term ExpressionReader::make_pose(std::uint32_t column) {
  Term out;
  out.column = column;
  const auto begin = arguments("POSE", column, 6, 6);
  if (!begin) return out;
  if (are_numbers(*begin, "POSE")) {
    std::array<double, 6> values{};
    std::array<Term, 6> terms;
    bool constant = true;
    for (std::size_t i = 0; i < 6; ++i) {
      const Term& argument = arguments_[*begin + i];
      constant = constant && argument.literal;
      values[i] = argument.number() * (i < 3 ? kMPerMm : kRadPerDeg);
    }
    if (constant) {
      out =
          terms_.value(pose_from_xyz_rpy({values[0], values[1], values[2]}, {values[3], values[4], values[5]}), column);
    } else {
      for (std::size_t i = 0; i < 6; ++i)
        terms[i] = terms_.scaled(arguments_[*begin + i], i < 3 ? kMPerMm : kRadPerDeg);
      out = terms_.apply(Operator::make_pose, column, terms);
    }
  }
  arguments_.resize(*begin);
  return out;
}

Term ExpressionReader::make_joints(std::uint32_t column) {
  Term out;
  out.column = column;
  const auto begin = arguments("JOINTS", column, 1, kMaxJointsPerRobot);
  if (!begin) return out;
  if (are_numbers(*begin, "JOINTS")) {
    JointPosition position;
    bool constant = true;
    for (const Term& argument : arguments_from(*begin)) {
      constant = constant && argument.literal;
      position.values[position.count++] = argument.number();
    }
    if (constant) {
      out = terms_.value(position, column);
    } else {
      for (std::size_t i = *begin; i < arguments_.size(); ++i) arguments_[i] = terms_.as_real(arguments_[i]);
      out = terms_.apply(Operator::make_joints, column, arguments_from(*begin),
                         static_cast<std::uint32_t>(JointUnits::degree_mm));
    }
  }
  arguments_.resize(*begin);
  return out;
}

Term ExpressionReader::port(Operator which, std::string_view text, std::uint32_t column) {
  Term out;
  out.column = column;
  const auto begin = arguments(text, column, 1, 1);
  if (!begin) return out;
  const Term number = arguments_[*begin];
  arguments_.resize(*begin);
  if (!number.known) return out;
  if (const auto value = terms_.constant_number(number);
      value && (*value < 1 || *value > static_cast<double>(kMostPorts))) {
    terms_.findings().error(number.column, fmt::format("{} has no number {}", text, *value),
                            fmt::format("numbers go from 1 to {}", kMostPorts));
    return out;
  }
  return terms_.apply(which, column, {number});
}

Term ExpressionReader::list_bound(Word which, std::uint32_t column) {
  Term out;
  out.column = column;
  if (!cursor_->take('('))
    return syntax_error(cursor_->column(), "a '(' is missing", "write the name of a list in brackets");
  cursor_->skip_blank();
  const std::uint32_t name_column = cursor_->column();
  const std::string_view name = cursor_->name();
  if (name.empty()) return syntax_error(name_column, "the name of a list is missing", "write it in the brackets");
  if (!cursor_->take(')')) return syntax_error(cursor_->column(), "a ')' is missing", "close the bracket");
  const Symbol* symbol = known_symbol(name, name_column);
  if (symbol == nullptr || symbol->kind == Symbol::Kind::unknown) return out;
  if (symbol->kind != Symbol::Kind::list || header_) {
    terms_.findings().error(name_column,
                            header_ ? fmt::format("'{}' has no value in the header section", name)
                                    : fmt::format("'{}' is not a list", name),
                            "write the name of a list, after END_HEADER");
    return out;
  }
  const Variable& list = terms_.builder().variable_of(symbol->variable);
  const auto count = static_cast<std::int64_t>(list.initial.size());
  if (which == Word::first) return integer_literal(list.first, column);
  return integer_literal(which == Word::last ? list.first + count - 1 : count, column);
}

AssignTarget ExpressionReader::read_target(Cursor& cursor) {
  cursor_ = &cursor;
  failed_ = false;
  depth_ = 0;
  arguments_.clear();
  cursor.skip_blank();
  AssignTarget target;
  target.column = cursor.column();
  const std::string_view name = cursor.name();
  if (name.empty() || find_word(name)) {
    syntax_error(target.column, "the name of a variable is missing", "write the variable that takes the result");
    return target;
  }
  const Symbol* symbol = known_symbol(name, target.column);
  Term index;
  cursor.skip_blank();
  const bool indexed = cursor.peek() == '[';
  if (indexed) index = list_index();
  std::string_view part;
  if (!failed_ && cursor.take('.')) part = cursor.name();
  if (failed_ || symbol == nullptr || symbol->kind == Symbol::Kind::unknown) return target;
  if (symbol->kind == Symbol::Kind::constant || indexed != (symbol->kind == Symbol::Kind::list)) {
    terms_.findings().error(
        target.column,
        symbol->kind == Symbol::Kind::constant ? fmt::format("'{}' is a CONSTANT", name)
        : indexed                              ? fmt::format("'{}' is not a list", name)
                                               : fmt::format("'{}' is a list", name),
        symbol->kind == Symbol::Kind::list ? fmt::format("write {}[index]", name) : "write the name of a variable");
    return target;
  }
  if (indexed && (!index.known || !has_element(symbol->variable, index))) return target;
  target.type = symbol->type;
  target.variable = symbol->variable;
  if (indexed) target.index = terms_.id(index);
  if (part.data() != nullptr) {
    const bool is_pose = symbol->type == ValueType::pose;
    const auto component = is_pose                             ? find_pose_component(part)
                           : symbol->type == ValueType::joints ? find_joint_component(part)
                                                               : std::nullopt;
    if (!component) {
      terms_.findings().error(target.column,
                              fmt::format("{} has no component '{}'", with_article(symbol->type), printable(part, 30)),
                              "poses have X, Y, Z, ROLL, PITCH and YAW, joint values J1, J2, ...");
      return target;
    }
    target.component = *component;
    target.type = ValueType::real;
    if (is_pose) target.si_per_written = 1.0 / written_per_si(*component);
  }
  target.known = true;
  return target;
}

}  // namespace cellmirror::program::irdata
