// WENN, the loops, jumps and subprograms.
#include <fmt/format.h>

#include "scripts/programs/srcl/keywords.hpp"
#include "scripts/programs/srcl/parser.hpp"

namespace cellmirror::program::srcl {

std::optional<bool> Parser::block_statement(const Token& at) {
  switch (at.keyword) {
    case Keyword::if_begin:
      return begin_if(at);
    case Keyword::else_if:
      return else_branch(at, true);
    case Keyword::otherwise:
      return else_branch(at, false);
    case Keyword::if_end:
      end_if(at);
      return true;
    case Keyword::while_begin:
      return begin_while(at);
    case Keyword::while_end:
      return end_loop(Keyword::while_begin, at);
    case Keyword::count_begin:
      return begin_count(at);
    case Keyword::count_end:
      return end_loop(Keyword::count_begin, at);
    case Keyword::repeat_begin:
    case Keyword::loop_begin:
      blocks_.open(at.keyword, at);
      return true;
    case Keyword::until:
      return end_repeat(at);
    case Keyword::loop_end:
      return end_loop(Keyword::loop_begin, at);
    default:
      return std::nullopt;
  }
}

std::optional<bool> Parser::flow_statement(const Token& at) {
  switch (at.keyword) {
    case Keyword::jump:
      return jump(at);
    case Keyword::leave:
      return leave_loop(at, false);
    case Keyword::next_round:
      return leave_loop(at, true);
    case Keyword::call:
      return call(at);
    case Keyword::return_back:
      if (blocks_.in_subprogram()) {
        emitter_.add(ReturnStatement{}, at);
      } else {
        faults_.add(at, fmt::format("{} is outside a subprogram", shown(at)), "end the program with ENDE");
      }
      return true;
    case Keyword::halt:
      emitter_.add(PauseStatement{}, at);
      return true;
    case Keyword::end:
      emitter_.add(EndStatement{}, at);
      return true;
    default:
      return std::nullopt;
  }
}

std::optional<Token> Parser::read_name(std::string_view what) {
  const Token token = lexer_.token();
  if (token.kind == TokenKind::name) {
    lexer_.advance();
    return token;
  }
  if (token.kind == TokenKind::keyword) {
    faults_.add(token, fmt::format("{} is a keyword, not a name", shown(token)),
                "choose another name, for example with a number appended");
  } else {
    faults_.add(token, fmt::format("the name of {} is missing before {}", what, shown(token)),
                "write a name: letters, digits and _, with a letter first");
  }
  return std::nullopt;
}

// None where it is wrong; `readable` is false where the rest of the line cannot be read.
ExpressionId Parser::read_condition(bool& readable) {
  const std::optional<Operand> condition = expressions_.read(ValueType::boolean, "the condition");
  readable = condition.has_value();
  return readable && condition->known() ? emitter_.expression(*condition) : kNoExpression;
}

bool Parser::begin_if(const Token& at) {
  bool readable = true;
  const ExpressionId condition = read_condition(readable);
  if (readable && lexer_.token().keyword == Keyword::jump) {
    const Token jump_at = lexer_.token();
    lexer_.advance();
    emitter_.add(BranchStatement{condition, emitter_.here() + 2}, at);  // behind the jump
    return jump(jump_at);
  }
  Block& block = blocks_.open(Keyword::if_begin, at);
  block.skip = emitter_.add(BranchStatement{condition, 0}, at);
  return readable && expressions_.expect(Keyword::then);
}

bool Parser::else_branch(const Token& at, bool with_condition) {
  Block* const block = blocks_.find_to_close(Keyword::if_begin, at);
  if (block == nullptr) return false;
  if (block->has_otherwise) {
    faults_.add(at, fmt::format("{} comes after the SONST of this WENN", shown(at)), "put SONST last");
  }
  block->exits.push_back(emitter_.add(JumpStatement{}, at));
  if (block->skip != kNone) emitter_.set_target(block->skip, emitter_.here());
  block->skip = kNone;
  blocks_.begin_branch();
  if (!with_condition && lexer_.token().keyword == Keyword::if_begin) {
    faults_.add(lexer_.token(), "WENN follows SONST on the same line", "write SONSTWENN, in one word");
    lexer_.advance();
    with_condition = true;
  }
  if (!with_condition) {
    block->has_otherwise = true;
    return true;
  }
  bool readable = true;
  const ExpressionId condition = read_condition(readable);
  block->skip = emitter_.add(BranchStatement{condition, 0}, at);
  return readable && expressions_.expect(Keyword::then);
}

void Parser::end_if(const Token& at) {
  if (blocks_.find_to_close(Keyword::if_begin, at) != nullptr) blocks_.close();
}

bool Parser::begin_while(const Token& at) {
  bool readable = true;
  Block& block = blocks_.open(Keyword::while_begin, at);
  const ExpressionId condition = read_condition(readable);
  block.skip = emitter_.add(BranchStatement{condition, 0}, at);
  return readable;
}

// ZAEHLE i VON a BIS b SCHRITT s: the bound is computed once.
bool Parser::begin_count(const Token& at) {
  Block& block = blocks_.open(Keyword::count_begin, at);
  const std::optional<Token> name = read_name("the loop variable");
  if (!name) return false;
  const Declared* const counter = expressions_.find(*name);
  if (counter != nullptr && (counter->kind != Declared::Kind::variable || counter->type != ValueType::integer)) {
    faults_.add(*name, fmt::format("{} cannot be a loop variable", shown(*name)), "count with a variable of GANZ");
  }
  if (!expressions_.expect(Keyword::from)) return false;
  const std::optional<Operand> begin = expressions_.read(ValueType::integer, "the first value of the count");
  if (!begin || !expressions_.expect(Keyword::until)) return false;
  const std::optional<Operand> end = expressions_.read(ValueType::integer, "the last value of the count");
  if (!end) return false;
  if (lexer_.token().keyword == Keyword::step) {
    lexer_.advance();
    const Token step_at = lexer_.token();
    const std::optional<Operand> step = expressions_.read_constant(ValueType::integer, "the step");
    if (!step) return false;
    if (step->known()) block.step = step->integer;
    if (block.step == 0) faults_.add(step_at, "the step is 0, so the count would never end", "write another step");
  }
  if (counter == nullptr || counter->variable == kNone || !begin->known() || !end->known()) return true;
  block.counter = counter->variable;
  AssignStatement start;
  start.variable = counter->variable;
  start.value = emitter_.expression(*begin);
  emitter_.add(start, at);
  Operand bound = *end;
  if (!end->constant()) {
    AssignStatement keep;
    keep.variable = emitter_.add_variable(fmt::format("#bound of line {}", at.line), ValueType::integer);
    keep.value = emitter_.expression(*end);
    emitter_.add(keep, at);
    bound = emitter_.node(Operator::variable, ValueType::integer, {}, keep.variable);
  }
  block.top = emitter_.here();
  const Operand value = emitter_.node(Operator::variable, ValueType::integer, {}, counter->variable);
  const Operand goes_on = emitter_.node(block.step < 0 ? Operator::greater_equal : Operator::less_equal,
                                        ValueType::boolean, {value, bound});
  block.skip = emitter_.add(BranchStatement{emitter_.expression(goes_on), 0}, at);
  return true;
}

bool Parser::end_loop(Keyword begin, const Token& at) {
  Block* const block = blocks_.find_to_close(begin, at);
  if (block == nullptr) return true;
  const StatementId first = block->top;
  if (block->counter != kNone) {
    block->top = emitter_.here();  // the next round begins with the step
    const Operand value = emitter_.node(Operator::variable, ValueType::integer, {}, block->counter);
    AssignStatement next;
    next.variable = block->counter;
    next.value =
        emitter_.expression(emitter_.node(Operator::add, ValueType::integer, {value, Operand::of(block->step)}));
    emitter_.add(next, at);
  }
  blocks_.jump_to(first, at);
  blocks_.close();
  return true;
}

bool Parser::end_repeat(const Token& at) {
  Block* const block = blocks_.find_to_close(Keyword::repeat_begin, at);
  bool readable = true;
  const StatementId decision = emitter_.here();
  const ExpressionId condition = read_condition(readable);
  if (block == nullptr) return false;
  emitter_.add(BranchStatement{condition, block->top}, at);
  block->top = decision;
  blocks_.close();
  return readable;
}

bool Parser::leave_loop(const Token& at, bool next_round) {
  Block* const loop = blocks_.innermost_loop();
  if (loop == nullptr) {
    faults_.add(at, fmt::format("{} is outside a loop", shown(at)), "put it into a loop, or use SPRUNG");
    return true;
  }
  const StatementId jump = emitter_.add(JumpStatement{}, at);
  (next_round ? loop->next_rounds : loop->exits).push_back(jump);
  return true;
}

bool Parser::jump(const Token& at) {
  const std::optional<Token> label = read_name("the label");
  if (!label) return false;
  blocks_.jump(*label, at);
  return true;
}

bool Parser::subprogram(const Token& at) {
  statement_seen_ = true;
  told_stray_ = false;
  const std::optional<Token> name = read_name("the subprogram");
  blocks_.begin_subprogram(name ? *name : at, at);
  return name.has_value();
}

bool Parser::call(const Token& at) {
  const std::optional<Token> name = read_name("the subprogram");
  if (!name) return false;
  blocks_.call(*name, at);
  return true;
}

}  // namespace cellmirror::program::srcl
