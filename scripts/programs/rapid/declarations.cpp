// CONST, PERS and VAR, and assignments.
#include <fmt/format.h>

#include <array>

#include "rt_core/base/text.hpp"
#include "scripts/programs/rapid/parser.hpp"

namespace cellmirror::program::rapid {
namespace {

std::optional<Type> type_of_word(const Token& word) {
  for (const Type type : {Type::num, Type::boolean, Type::robtarget, Type::jointtarget, Type::speeddata}) {
    if (equal_ignoring_case(word.text, word_of(type))) return type;
  }
  return std::nullopt;
}

}  // namespace

bool Parser::declaration(const Token& at) {
  const Keeps keeps = at.is("CONST") ? Keeps::constant : at.is("PERS") ? Keeps::persistent : Keeps::variable;
  if (!module_) {
    values_.error(at, fmt::format("{} is outside a module", shown(at)), "write MODULE and a name before it");
    module_ = at;
  }
  if (keeps == Keeps::persistent && procedure_) {
    values_.error(at, "PERS is not allowed in a procedure", "declare it in the module, or with VAR");
  }
  if (!blocks_.empty()) {
    values_.error(at, "data cannot be declared within IF, FOR or WHILE",
                  "declare it at the beginning of the procedure");
  }
  const Token type_name = lexer_.token();
  if (type_name.kind != TokenKind::word) {
    values_.error(type_name, fmt::format("a data type is missing before {}", shown(type_name)),
                  "write num, bool, robtarget, jointtarget or speeddata");
    return false;
  }
  lexer_.advance();
  mark(at);
  do {
    if (lexer_.at(Sign::comma)) lexer_.advance();
    if (!declare_one(keeps, type_name)) return false;
  } while (lexer_.at(Sign::comma));
  end_statement(at, true);
  return true;
}

bool Parser::declare_one(Keeps keeps, const Token& type_name) {
  const std::optional<Type> type = type_of_word(type_name);
  if (!type) return refuse_type(type_name);
  const Token name = lexer_.token();
  if (name.kind != TokenKind::word) {
    values_.error(name, fmt::format("a name is missing before {}", shown(name)),
                  "write a name: letters, digits and _, with a letter first");
    return false;
  }
  lexer_.advance();
  if (lexer_.at(Sign::open_index)) {
    values_.error(lexer_.token(), "arrays are not in the subset", "declare single data, as in p1, p2, p3");
    names_.add(name.text, Declared{});
    return false;
  }
  if (*type == Type::speeddata) return declare_speed(name);
  std::optional<Value> initial;
  bool valid = true;
  if (lexer_.at(Sign::becomes)) {
    lexer_.advance();
    initial = values_.read_constant(*type, fmt::format("the value of {}", name.text), valid);
    if (!initial) {
      names_.add(name.text, Declared{});
      return false;
    }
  } else if (keeps != Keeps::variable) {
    values_.error(name, fmt::format("{} has no value", shown(name)), "write ':=' and a value behind the name");
    valid = false;
  }
  declare(name, *type, keeps, std::move(initial), valid);
  return true;
}

bool Parser::refuse_type(const Token& type_name) {
  const Token name = lexer_.token();
  const bool frame = type_name.is("TOOLDATA") || type_name.is("WOBJDATA");
  if (frame) {
    const bool tool = equal_ignoring_case(type_name.text, "tooldata");
    values_.error(type_name,
                  fmt::format("{} other than {} is not in the subset", type_name.text, tool ? "tool0" : "wobj0"),
                  tool ? "teach the robtargets with tool0" : "teach the robtargets with wobj0");
  } else {
    values_.error(type_name, fmt::format("the data type {} is not in the subset", shown(type_name)),
                  "use num, bool, robtarget, jointtarget or speeddata");
  }
  if (name.kind == TokenKind::word) names_.add(name.text, Declared{});
  return false;
}

bool Parser::new_name(const Token& name) {
  const Declared* const earlier = names_.find_in_scope(name.text);
  if (earlier == nullptr) return true;
  values_.error(name,
                earlier->line == 0 ? fmt::format("{} exists already", shown(name))
                                   : fmt::format("{} exists already, in line {}", shown(name), earlier->line),
                "give one of the two another name");
  return false;
}

void Parser::declare(const Token& name, Type type, Keeps keeps, std::optional<Value> initial, bool valid) {
  if (!new_name(name)) return;
  Declared declared;
  declared.type = type;
  declared.line = name.line;
  if (keeps == Keeps::constant) {
    declared.storage = valid ? Declared::Storage::constant : Declared::Storage::unusable;
    if (valid) declared.value = std::move(*initial);
    names_.add(name.text, declared);
    return;
  }
  const Value value = initial && valid ? std::move(*initial) : default_value(value_type(type));
  // Local data is a variable of the whole program with a name of its own: it exists once, and gets its value again
  // whenever the procedure is called.
  const std::string full = procedure_
                               ? fmt::format("{}.{} of line {}:{}", procedure_->text, name.text, name.line, name.column)
                               : std::string(name.text);
  const Result<VariableId> made = builder_.declare(full, value_type(type), value);
  if (!made) {
    values_.error(name, made.error());
    return;
  }
  declared.storage = Declared::Storage::variable;
  declared.variable = *made;
  names_.add(name.text, declared);
  if (procedure_) add(name, AssignStatement{.variable = *made, .value = builder_.constant(value)});
}

// Speeds are not computed: all speeddata is constant, however it is declared.
bool Parser::declare_speed(const Token& name) {
  Declared declared;
  declared.type = Type::speeddata;
  declared.line = name.line;
  bool known = false;
  if (!lexer_.at(Sign::becomes)) {
    values_.error(name, fmt::format("{} has no value", shown(name)), "write ':=' and [v_tcp, v_ori, v_leax, v_reax]");
  } else {
    lexer_.advance();
    const std::optional<Speed> speed = values_.read_speed(known);
    if (!speed) {
      names_.add(name.text, Declared{});
      return false;
    }
    declared.speed = *speed;
  }
  if (known) declared.storage = Declared::Storage::constant;
  if (new_name(name)) names_.add(name.text, declared);
  return true;
}

bool Parser::assign(const Token& name) {
  const Declared* const found = values_.find(name);
  const Declared declared = found == nullptr ? Declared{} : *found;
  if (lexer_.at(Sign::open_index)) {
    values_.error(lexer_.token(), "arrays are not in the subset", "assign to single data");
    return false;
  }
  ExpressionReader::Component component;
  const bool part = lexer_.at(Sign::dot);
  const Token dot = lexer_.token();
  if (part) {
    const auto read = values_.read_component(declared.type);
    if (!read) return false;
    component = *read;
  }
  if (!values_.expect(Sign::becomes, ":=") || found == nullptr) return false;
  if (declared.storage != Declared::Storage::variable) {
    const bool counter = declared.storage == Declared::Storage::counter;
    values_.error(name, fmt::format("{} cannot be set", shown(name)),
                  counter                            ? "FOR counts by itself: use another num"
                  : declared.type == Type::speeddata ? "speeddata is constant here: declare several"
                                                     : fmt::format("declare it with VAR in line {}", declared.line));
    return false;
  }
  std::optional<Operand> value =
      values_.read(part ? Type::num : declared.type, fmt::format("the value of {}", name.text));
  if (!value) return false;
  if (!value->known()) return true;
  if (part && component.si_factor != 1) {
    const auto product = builder_.operation(Operator::multiply, {value->id, builder_.real(component.si_factor)});
    if (!product) {
      values_.error(dot, product.error());
      return true;
    }
    value->id = *product;
  }
  AssignStatement assignment{.variable = declared.variable, .value = value->id};
  if (part) assignment.component = component.index;
  add(name, assignment);
  return true;
}

}  // namespace cellmirror::program::rapid
