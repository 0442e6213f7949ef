// PROGRAMM, GANZ, REAL, LOGIK, LAGE, STELLUNG, FEST, LISTE, SEMAPHOR.
#include <fmt/format.h>

#include <utility>

#include "rt_core/base/capacity.hpp"
#include "scripts/programs/srcl/keywords.hpp"
#include "scripts/programs/srcl/parser.hpp"

namespace cellmirror::program::srcl {

namespace {

constexpr std::int64_t kMostSemaphoreCount = 1'000'000;

}  // namespace

bool Parser::program_name(const Token& at) {
  if (statement_seen_) faults_.add(at, "PROGRAMM comes after other statements", "make it the first line");
  statement_seen_ = true;
  const std::optional<Token> name = read_name("the program");
  if (!name) return false;
  if (name->text.size() > kMaxNameLength) {
    faults_.add(*name, fmt::format("the name is longer than {} characters", kMaxNameLength), "shorten it");
  }
  program_.name = std::string(name->text);
  return true;
}

// A new name. If it is not free, that is reported, and reading continues.
std::optional<Token> Parser::read_new_name(std::string_view what) {
  const std::optional<Token> name = read_name(what);
  statement_seen_ = true;
  if (!name) return std::nullopt;
  if (name->text.size() > kMaxNameLength) {
    faults_.add(*name, fmt::format("the name is longer than {} characters", kMaxNameLength), "shorten it");
  } else if (const Declared* const earlier = names_.find(name->text)) {
    faults_.add(*name, fmt::format("{} is declared already, in line {}", shown(*name), earlier->line),
                "give one of the two another name");
  }
  return name;
}

std::optional<ValueType> Parser::read_type() {
  const Token token = lexer_.token();
  std::optional<ValueType> type;
  switch (token.keyword) {
    case Keyword::integer:
      type = ValueType::integer;
      break;
    case Keyword::real:
      type = ValueType::real;
      break;
    case Keyword::boolean:
      type = ValueType::boolean;
      break;
    case Keyword::pose:
      type = ValueType::pose;
      break;
    case Keyword::joints:
      type = ValueType::joints;
      break;
    default:
      faults_.add(token, fmt::format("a type is missing before {}", shown(token)),
                  faults_.proposal(token.text, {"GANZ", "REAL", "LOGIK", "LAGE", "STELLUNG"},
                                   "write GANZ, REAL, LOGIK, LAGE or STELLUNG"));
      return std::nullopt;
  }
  lexer_.advance();
  return type;
}

// Of a constant; unreferenced poses and joints are removed from the program's constants again.
Value Parser::take_value(const Operand& constant, std::size_t constants_before) {
  Value value = emitter_.value_of(constant);
  if (constant.form != Operand::Form::stored) return value;
  if (constant.index >= constants_before && constant.index + 1 == program_.constants.size())
    program_.constants.pop_back();
  return value;
}

bool Parser::declare_variables(ValueType type) {
  for (;;) {
    const std::optional<Token> name = read_new_name("the variable");
    if (!name) return false;
    Declared declared;
    declared.type = type;
    declared.line = name->line;
    declared.variable = emitter_.add_variable(std::string(name->text), type);
    names_.add(name->text, declared);
    if (lexer_.token().sign == Sign::equal) {
      lexer_.advance();
      const std::size_t before = program_.constants.size();
      const std::optional<Operand> value = expressions_.read_constant(type, "the value at the beginning");
      if (!value) return false;
      if (value->known()) program_.variables[declared.variable].initial.front() = take_value(*value, before);
    }
    if (lexer_.token().sign != Sign::comma) return true;
    lexer_.advance();
  }
}

bool Parser::declare_constants() {
  const std::optional<ValueType> type = read_type();
  if (!type) return false;
  for (;;) {
    const std::optional<Token> name = read_new_name("the constant");
    if (!name || !expressions_.expect(Sign::equal, "=")) return false;
    Declared declared;
    declared.kind = Declared::Kind::constant;
    declared.type = *type;
    declared.line = name->line;
    const std::optional<Operand> value = expressions_.read_constant(*type, "the value of a constant");
    if (value) declared.value = *value;
    names_.add(name->text, declared);
    if (!value) return false;
    if (lexer_.token().sign != Sign::comma) return true;
    lexer_.advance();
  }
}

// "(first:last)" or "(last)".
bool Parser::read_list_bounds(Declared& list) {
  if (!expressions_.expect(Sign::open, "(")) return false;
  const Token at = lexer_.token();
  std::optional<Operand> bound = expressions_.read_constant(ValueType::integer, "the bound of a list");
  if (!bound) return false;
  if (lexer_.token().sign == Sign::colon) {
    lexer_.advance();
    if (bound->known()) list.first = bound->integer;
    bound = expressions_.read_constant(ValueType::integer, "the bound of a list");
    if (!bound) return false;
  }
  if (!expressions_.expect(Sign::close, ")")) return false;
  list.last = bound->known() ? bound->integer : list.first;
  const std::uint64_t beyond_first = static_cast<std::uint64_t>(list.last) - static_cast<std::uint64_t>(list.first);
  if (list.last < list.first) {
    faults_.add(at, "the list has no elements", "write the smaller bound first, as in (1:10)");
  } else if (beyond_first >= kMostListElements - list_elements_) {
    faults_.add(at, fmt::format("the lists have more than {} elements together", kMostListElements),
                "make them smaller");
  } else {
    list_elements_ += static_cast<std::size_t>(beyond_first) + 1;
    return true;
  }
  list.last = list.first;
  return true;
}

bool Parser::declare_list() {
  const std::optional<ValueType> type = read_type();
  if (!type) return false;
  const std::optional<Token> name = read_new_name("the list");
  if (!name) return false;
  Declared declared;
  declared.kind = Declared::Kind::list;
  declared.type = *type;
  declared.line = name->line;
  const std::size_t faults_before = faults_.count();
  if (!read_list_bounds(declared)) return false;
  declared.variable = emitter_.add_variable(std::string(name->text), *type);
  names_.add(name->text, declared);
  Variable& variable = program_.variables[declared.variable];
  variable.list = true;
  variable.first = declared.first;
  if (faults_.count() > faults_before) return false;
  const auto size = static_cast<std::size_t>(declared.last - declared.first) + 1;
  if (lexer_.token().sign != Sign::equal) {
    variable.initial.resize(size, Value(variable.initial.front()));
    return true;
  }
  lexer_.advance();
  return read_list_values(variable, size);
}

// One for all elements, or one for each.
bool Parser::read_list_values(Variable& variable, std::size_t size) {
  const Token at = lexer_.token();
  std::vector<Value> values;
  for (;;) {
    const Token value_at = lexer_.token();
    const std::size_t before = program_.constants.size();
    const std::optional<Operand> value = expressions_.read_constant(variable.type, "the element of a list");
    if (!value) return false;
    if (values.size() == size) {
      faults_.add(value_at, fmt::format("the list {} has {} elements, but more values", variable.name, size),
                  "delete the surplus ones, or make the list longer");
      return false;
    }
    values.push_back(value->known() ? take_value(*value, before) : variable.initial.front());
    if (lexer_.token().sign != Sign::comma) break;
    lexer_.advance();
  }
  if (values.size() == 1) {
    variable.initial.assign(size, Value(values.front()));
  } else if (values.size() == size) {
    variable.initial = std::move(values);
  } else {
    faults_.add(at, fmt::format("the list {} has {} elements, but {} values", variable.name, size, values.size()),
                "write one value for all, or one for each element");
  }
  return true;
}

// Without a count it is one that another program declares.
bool Parser::declare_semaphore() {
  const std::optional<Token> name = read_new_name("the semaphore");
  if (!name) return false;
  Declared declared;
  declared.kind = Declared::Kind::semaphore;
  declared.line = name->line;
  names_.add(name->text, declared);
  if (lexer_.token().sign != Sign::equal) return true;
  lexer_.advance();
  const Token at = lexer_.token();
  const std::optional<Operand> count = expressions_.read_constant(ValueType::integer, "the count of a semaphore");
  if (!count) return false;
  if (!count->known()) return true;
  if (count->integer < 0 || count->integer > kMostSemaphoreCount) {
    faults_.add(at, fmt::format("a semaphore cannot begin with {}", count->integer),
                fmt::format("write a count from 0 to {}", kMostSemaphoreCount));
    return true;
  }
  program_.semaphores.push_back({std::string(name->text), static_cast<std::uint32_t>(count->integer), name->line});
  return true;
}

}  // namespace cellmirror::program::srcl
