// Outputs, waits and texts.
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "rt_core/base/text.hpp"
#include "scripts/programs/rapid/parser.hpp"

namespace cellmirror::program::rapid {

// SetDO do1, value: 0 is off, any other number on.
bool Parser::set_output(const Token& at) {
  if (!refuse_switches(false)) return false;
  if (lexer_.at(Sign::comma)) lexer_.advance();
  const std::optional<Operand> signal = values_.read_signal(true);
  if (!signal || !values_.expect(Sign::comma, ",")) return false;
  const Token value_at = lexer_.token();
  const std::optional<Operand> value = values_.read(Type::num, "the value of the output");
  if (!value) return false;
  if (!signal->known() || !value->known()) return true;
  const auto on = builder_.operation(Operator::not_equal, {value->id, builder_.real(0)});
  if (!on) {
    values_.error(value_at, on.error());
    return true;
  }
  add(at, OutputStatement{.analogue = false, .number = builder_.integer(signal->port), .value = *on});
  return true;
}

bool Parser::set_on(const Token& at) { return switch_output(at, true); }
bool Parser::set_off(const Token& at) { return switch_output(at, false); }

bool Parser::switch_output(const Token& at, bool on) {
  const std::optional<Operand> signal = values_.read_signal(true);
  if (!signal) return false;
  if (!signal->known()) return true;
  const ExpressionId number = builder_.integer(signal->port);
  add(at, OutputStatement{.analogue = false, .number = number, .value = builder_.boolean(on)});
  return true;
}

bool Parser::wait_time(const Token& at) {
  if (!refuse_switches(false)) return false;
  if (lexer_.at(Sign::comma)) lexer_.advance();
  const std::optional<Operand> seconds = values_.read(Type::num, "the time");
  if (!seconds) return false;
  if (seconds->known()) add(at, DelayStatement{seconds->id});
  return true;
}

// WaitDI di1, 1 [\MaxTime:=s] [\TimeFlag:=b]
bool Parser::wait_input(const Token& at) {
  const Token first = lexer_.token();
  const std::optional<Operand> signal = values_.read_signal(false);
  if (!signal || !values_.expect(Sign::comma, ",")) return false;
  const std::optional<bool> level = values_.read_level();
  if (!level) return false;
  WaitStatement statement;
  statement.text = builder_.text(lexer_.text_since(first));
  if (!wait_options(statement)) return false;
  if (!signal->known()) return true;
  auto condition = builder_.operation(Operator::digital_input, {builder_.integer(signal->port)});
  if (condition && !*level) condition = builder_.operation(Operator::logical_not, {*condition});
  if (!condition) {
    values_.error(first, condition.error());
    return true;
  }
  statement.condition = *condition;
  add(at, statement);
  return true;
}

bool Parser::wait_options(WaitStatement& statement) {
  while (lexer_.at(Sign::backslash)) {
    const Token backslash = lexer_.token();
    lexer_.advance();
    const Token name = lexer_.token();
    if (!name.is("MAXTIME") && !name.is("TIMEFLAG")) {
      values_.error(backslash, fmt::format("the switch \\{} is not in the subset", printable(name.text, 40)),
                    "write \\MaxTime:=seconds or \\TimeFlag:=a bool, or delete it");
      return false;
    }
    lexer_.advance();
    if (!values_.expect(Sign::becomes, ":=")) return false;
    if (name.is("MAXTIME")) {
      const std::optional<Operand> seconds = values_.read(Type::num, "the time");
      if (!seconds) return false;
      if (seconds->known()) statement.timeout_s = seconds->id;
      continue;
    }
    const Token flag = lexer_.token();
    if (flag.kind != TokenKind::word) {
      values_.error(flag, "the bool of \\TimeFlag is missing", "write the name of a VAR bool");
      return false;
    }
    lexer_.advance();
    const Declared* const declared = values_.find(flag);
    if (declared == nullptr) continue;
    if (declared->storage == Declared::Storage::variable && declared->type == Type::boolean) {
      statement.timed_out = declared->variable;
    } else {
      values_.error(flag, fmt::format("{} cannot hold the result of the wait", shown(flag)),
                    "write the name of a VAR bool");
    }
  }
  return true;
}

// A message to people: hot_message of SCRIPT takes the rest of its line as the text.
bool Parser::write_text(const Token& at) {
  const Token text = lexer_.token();
  if (text.kind != TokenKind::text) {
    values_.error(text,
                  text.kind == TokenKind::bad_text ? "the text does not end in its line"
                                                   : fmt::format("a text is missing before {}", shown(text)),
                  "write TPWrite \"...\";");
    return false;
  }
  lexer_.advance();
  std::string words(text.text.substr(1, text.text.size() - 2));
  for (std::size_t quote = words.find("\"\""); quote != std::string::npos; quote = words.find("\"\"", quote + 1)) {
    words.erase(quote, 1);
  }
  std::replace(words.begin(), words.end(), ';', ',');  // would end the command
  std::replace_if(words.begin(), words.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  const std::string_view message = trimmed(words);
  if (!message.empty()) add(at, ScriptStatement{builder_.text("hot_message " + std::string(message))});
  return refuse_switches(false);
}

}  // namespace cellmirror::program::rapid
