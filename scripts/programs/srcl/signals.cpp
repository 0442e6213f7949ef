// WARTE, AUSGANG, ANALOG_AUS, BELEGE, FREI.
#include <fmt/format.h>

#include <string>

#include "scripts/programs/srcl/keywords.hpp"
#include "scripts/programs/srcl/parser.hpp"

namespace cellmirror::program::srcl {

std::optional<bool> Parser::signal_statement(const Token& at) {
  switch (at.keyword) {
    case Keyword::wait:
      return wait(at);
    case Keyword::acquire:
      return semaphore(at, true);
    case Keyword::release:
      return semaphore(at, false);
    case Keyword::digital_output:
      return output(at, false);
    case Keyword::analogue_output:
      return output(at, true);
    default:
      return std::nullopt;
  }
}

void Parser::check_time(const Token& at, const Operand& seconds) {
  if (!seconds.constant() || (seconds.real >= 0 && seconds.real <= kLongestTime_s)) return;
  faults_.add(at, fmt::format("a program cannot wait for {} s", seconds.real),
              fmt::format("write a time from 0 to {} s", kLongestTime_s));
}

bool Parser::wait(const Token& at) {
  if (lexer_.token().keyword == Keyword::until) {
    lexer_.advance();
    return wait_for(at);
  }
  const Token value_at = lexer_.token();
  const std::optional<Operand> seconds = expressions_.read(ValueType::real, "the time");
  if (!seconds) return false;
  if (!seconds->known()) return true;
  check_time(value_at, *seconds);
  emitter_.add(DelayStatement{emitter_.expression(*seconds)}, at);
  return true;
}

bool Parser::wait_for(const Token& at) {
  WaitStatement statement;
  const Token first = lexer_.token();
  bool readable = true;
  statement.condition = read_condition(readable);
  if (!readable) return false;
  statement.text = emitter_.text(lexer_.text_since(first));
  std::optional<Token> jump_to;
  if (lexer_.token().keyword == Keyword::at_most && !wait_limit(statement, at, jump_to)) return false;
  emitter_.add(statement, at);
  if (!jump_to) return true;
  const Operand over = emitter_.node(Operator::variable, ValueType::boolean, {}, statement.timed_out);
  emitter_.add(BranchStatement{emitter_.expression(over), emitter_.here() + 2}, at);
  blocks_.jump(*jump_to, at);
  return true;
}

// HOECHSTENS seconds [MELDE variable | SPRUNG label]
bool Parser::wait_limit(WaitStatement& statement, const Token& at, std::optional<Token>& jump_to) {
  lexer_.advance();
  const Token value_at = lexer_.token();
  const std::optional<Operand> seconds = expressions_.read(ValueType::real, "the time");
  if (!seconds) return false;
  if (seconds->known()) {
    check_time(value_at, *seconds);
    statement.timeout_s = emitter_.expression(*seconds);
  }
  if (lexer_.token().keyword == Keyword::jump) {
    lexer_.advance();
    jump_to = read_name("the label");
    statement.timed_out = emitter_.add_variable(fmt::format("#time is over in line {}", at.line), ValueType::boolean);
    return jump_to.has_value();
  }
  if (lexer_.token().keyword != Keyword::notify) return true;
  lexer_.advance();
  const std::optional<Token> name = read_name("the variable");
  if (!name) return false;
  const Declared* const declared = expressions_.find(*name);
  if (declared == nullptr) return true;
  if (declared->kind != Declared::Kind::variable || declared->type != ValueType::boolean) {
    faults_.add(*name, fmt::format("{} cannot hold the timeout result", shown(*name)), "use a variable of LOGIK");
    return true;
  }
  statement.timed_out = declared->variable;
  return true;
}

bool Parser::output(const Token& at, bool analogue) {
  const std::optional<Operand> number = expressions_.read_port();
  if (!number || !expressions_.expect(Sign::equal, "=")) return false;
  const std::optional<Operand> value =
      expressions_.read(analogue ? ValueType::real : ValueType::boolean, "the value of the output");
  if (!value) return false;
  if (!number->known() || !value->known()) return true;
  OutputStatement statement;
  statement.analogue = analogue;
  statement.number = emitter_.expression(*number);
  statement.value = emitter_.expression(*value);
  emitter_.add(statement, at);
  return true;
}

bool Parser::semaphore(const Token& at, bool acquire) {
  const std::optional<Token> name = read_name("the semaphore");
  if (!name) return false;
  const Declared* const declared = expressions_.find(*name);
  if (declared == nullptr) return true;
  if (declared->kind != Declared::Kind::semaphore) {
    faults_.add(*name, fmt::format("{} is not a semaphore", shown(*name)), "declare it with SEMAPHOR before");
    return true;
  }
  emitter_.add(SemaphoreStatement{acquire, emitter_.text(name->text)}, at);
  return true;
}

}  // namespace cellmirror::program::srcl
