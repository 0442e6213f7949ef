// IF, FOR, WHILE, and what ends or pauses a program.
#include <fmt/format.h>

#include <array>
#include <utility>

#include "scripts/programs/rapid/parser.hpp"

namespace cellmirror::program::rapid {
namespace {

constexpr auto kBegins = std::to_array<std::string_view>({"IF", "IF", "FOR", "WHILE"});

}  // namespace

bool Parser::block_word(const Token& at) {
  if (!blocks_.empty() && blocks_.back().kind == BlockKind::if_short) {
    values_.error(blocks_.back().at, "IF without THEN needs one statement behind its condition",
                  "write THEN and ENDIF for more than one statement");
    close();
  }
  if (at.is("IF")) return begin_if(at);
  if (at.is("ELSEIF") || at.is("ELSE")) return else_branch(at);
  if (at.is("FOR")) return begin_for(at);
  if (at.is("WHILE")) return begin_while(at);
  end_block(at);
  return true;
}

Parser::Block& Parser::open(BlockKind kind, const Token& at) {
  if (blocks_.size() >= kMostNested && !std::exchange(told_depth_, true)) {
    values_.error(at, fmt::format("more than {} nested blocks", kMostNested), "move some into a procedure");
  }
  Block& block = blocks_.emplace_back();
  block.kind = kind;
  block.at = at;
  block.top = builder_.new_label();
  block.skip = builder_.new_label();
  block.end = builder_.new_label();
  return block;
}

void Parser::close() {
  Block& block = blocks_.back();
  if (!builder_.bound(block.top)) builder_.bind(block.top);
  if (!builder_.bound(block.skip)) builder_.bind(block.skip);
  builder_.bind(block.end);
  if (block.kind == BlockKind::for_do) names_.pop_counter();
  blocks_.pop_back();
}

// One statement has been read.
void Parser::close_short_if() {
  if (!blocks_.empty() && blocks_.back().kind == BlockKind::if_short) close();
}

// Closes what is open within; false, and reported, where there is no such block.
bool Parser::find_to_close(BlockKind kind, const Token& at) {
  std::size_t found = blocks_.size();
  // Bounded: only permitted nesting levels are searched.
  for (std::size_t looked = 0; found > 0 && looked <= kMostNested; --found, ++looked) {
    if (blocks_[found - 1].kind == kind) break;
  }
  if (found == 0 || blocks_[found - 1].kind != kind) {
    const std::string_view begin = kBegins.at(static_cast<std::size_t>(kind));
    values_.error(at, fmt::format("{} has no {} before it", shown(at), begin),
                  fmt::format("write {} before it, or delete it", begin));
    return false;
  }
  while (blocks_.size() > found) {
    const auto inner = static_cast<std::size_t>(blocks_.back().kind);
    values_.error(blocks_.back().at,
                  fmt::format("{} is not closed before {} in line {}", kBegins.at(inner), shown(at), at.line),
                  fmt::format("write {} before that line", kBlockEnds.at(inner)));
    close();
  }
  return true;
}

void Parser::branch(Block& block, const std::optional<Operand>& condition, const Token& at) {
  if (!condition || !condition->known()) return;
  mark(at);
  if (const auto added = builder_.branch_unless(condition->id, block.skip); !added) values_.error(at, added.error());
}

bool Parser::begin_if(const Token& at) {
  Block& block = open(BlockKind::if_then, at);
  const std::optional<Operand> condition = values_.read(Type::boolean, "the condition");
  branch(block, condition, at);
  if (!condition) return false;
  if (lexer_.at("THEN")) {
    lexer_.advance();
    return true;
  }
  if (lexer_.token().kind != TokenKind::word || lexer_.token().begins_line) return values_.expect_word("THEN");
  block.kind = BlockKind::if_short;
  return true;
}

bool Parser::else_branch(const Token& at) {
  if (!find_to_close(BlockKind::if_then, at)) return false;
  Block& block = blocks_.back();
  if (block.has_else) values_.error(at, fmt::format("{} comes after the ELSE of this IF", shown(at)), "put ELSE last");
  mark(at);
  builder_.jump(block.end);
  if (!builder_.bound(block.skip)) builder_.bind(block.skip);
  block.skip = builder_.new_label();
  if (at.is("ELSE")) {
    block.has_else = true;
    return true;
  }
  const std::optional<Operand> condition = values_.read(Type::boolean, "the condition");
  branch(block, condition, at);
  return condition && values_.expect_word("THEN");
}

bool Parser::begin_while(const Token& at) {
  Block& block = open(BlockKind::while_do, at);
  builder_.bind(block.top);
  const std::optional<Operand> condition = values_.read(Type::boolean, "the condition");
  branch(block, condition, at);
  return condition && values_.expect_word("DO");
}

VariableId Parser::hidden(const Token& at, std::string_view what, ExpressionId value) {
  const Result<VariableId> made =
      builder_.declare(fmt::format("{} of line {}:{}", what, at.line, at.column), ValueType::real);
  if (!made) {
    values_.error(at, made.error());
    return kNone;
  }
  add(at, AssignStatement{.variable = *made, .value = value});
  return *made;
}

// FOR i FROM a TO b STEP s DO: bound and step are computed once; the counter is data of the loop.
bool Parser::begin_for(const Token& at) {
  Block& block = open(BlockKind::for_do, at);
  const Token name = lexer_.token();
  names_.push_counter(name.kind == TokenKind::word ? name.text : "", Declared{});
  if (name.kind != TokenKind::word) {
    values_.error(name, fmt::format("the counter of FOR is missing before {}", shown(name)),
                  "write FOR i FROM 1 TO 3 DO");
    return false;
  }
  lexer_.advance();
  if (!values_.expect_word("FROM")) return false;
  const std::optional<Operand> first = values_.read(Type::num, "the first value of FOR");
  if (!first || !values_.expect_word("TO")) return false;
  const std::optional<Operand> last = values_.read(Type::num, "the last value of FOR");
  if (!last) return false;
  std::optional<Operand> step;
  const Token step_at = lexer_.token();
  if (lexer_.at("STEP")) {
    lexer_.advance();
    step = values_.read(Type::num, "the step of FOR");
    if (!step) return false;
    const Value* const value = step->known() ? builder_.constant_value(step->id) : nullptr;
    if (value != nullptr && std::get<double>(*value) == 0) {
      values_.error(step_at, "the step of FOR is 0, so it would never end", "write another step");
    }
  }
  if (!values_.expect_word("DO")) return false;
  if (!first->known() || !last->known() || (step && !step->known())) return true;
  const Value* const from = builder_.constant_value(first->id);
  const Value* const to = builder_.constant_value(last->id);
  std::optional<double> known_step;
  if (!step && from != nullptr && to != nullptr) known_step = std::get<double>(*to) < std::get<double>(*from) ? -1 : 1;
  if (step) {
    if (const Value* const value = builder_.constant_value(step->id)) known_step = std::get<double>(*value);
  }
  return begin_rounds(name, block, *first, *last, known_step, step);
}

// Without STEP it counts by 1 towards the last value, by -1 where that is below the first one.
bool Parser::begin_rounds(const Token& name, Block& block, const Operand& first, const Operand& last,
                          std::optional<double> known_step, const std::optional<Operand>& step) {
  const std::string counter_name(name.text);
  const VariableId bound = hidden(name, "last value of " + counter_name, last.id);
  block.counter = hidden(name, counter_name, first.id);
  if (bound == kNone || block.counter == kNone) return true;
  const auto variable = [this](VariableId id) { return *builder_.variable(id); };
  block.step_value = known_step.value_or(1);
  if (!known_step) {
    block.step = hidden(name, "step of " + counter_name, step ? step->id : builder_.real(1));
    if (block.step == kNone) return true;
    if (!step) {
      const Label upward = builder_.new_label();
      const auto downward = builder_.operation(Operator::less, {variable(bound), variable(block.counter)});
      if (const auto added = builder_.branch_unless(*downward, upward); !added) values_.error(name, added.error());
      add(name, AssignStatement{.variable = block.step, .value = builder_.real(-1)});
      builder_.bind(upward);
    }
  }
  names_.pop_counter();
  names_.push_counter(name.text, Declared{.storage = Declared::Storage::counter,
                                          .type = Type::num,
                                          .variable = block.counter,
                                          .value = {},
                                          .speed = {},
                                          .line = name.line});
  builder_.bind(block.top);
  Operand goes_on{Type::boolean};
  if (known_step) {
    const Operator which = *known_step < 0 ? Operator::greater_equal : Operator::less_equal;
    goes_on.id = *builder_.operation(which, {variable(block.counter), variable(bound)});
  } else {  // (counter - bound) * step <= 0, whatever the sign of the step is
    const ExpressionId rest = *builder_.operation(Operator::subtract, {variable(block.counter), variable(bound)});
    const ExpressionId product = *builder_.operation(Operator::multiply, {rest, variable(block.step)});
    goes_on.id = *builder_.operation(Operator::less_equal, {product, builder_.real(0)});
  }
  branch(block, goes_on, name);
  return true;
}

void Parser::end_block(const Token& at) {
  const BlockKind kind = at.is("ENDIF")    ? BlockKind::if_then
                         : at.is("ENDFOR") ? BlockKind::for_do
                                           : BlockKind::while_do;
  if (!find_to_close(kind, at)) return;
  const Block& block = blocks_.back();
  if (block.counter != kNone && builder_.bound(block.top)) {
    const ExpressionId counter = *builder_.variable(block.counter);
    const ExpressionId step = block.step == kNone ? builder_.real(block.step_value) : *builder_.variable(block.step);
    add(at, AssignStatement{.variable = block.counter, .value = *builder_.operation(Operator::add, {counter, step})});
  }
  if (kind != BlockKind::if_then && builder_.bound(block.top)) builder_.jump(block.top);
  close();
}

bool Parser::stop(const Token& at) {
  add(at, PauseStatement{});
  return refuse_switches(false);
}

bool Parser::exit_program(const Token& at) {
  add(at, EndStatement{});
  return true;
}

bool Parser::return_back(const Token& at) {
  add(at, ReturnStatement{});
  if (lexer_.at(Sign::semicolon)) return true;
  values_.error(lexer_.token(), "RETURN of a procedure has no value", "write 'RETURN;'");
  return false;
}

}  // namespace cellmirror::program::rapid
