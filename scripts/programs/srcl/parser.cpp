#include "scripts/programs/srcl/parser.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "scripts/programs/program/program_check.hpp"
#include "scripts/programs/srcl/keywords.hpp"

namespace cellmirror::program::srcl {

Parser::Parser(std::string_view text, const ParseContext& context)
    : lexer_(text),
      faults_(context.file),
      emitter_(program_),
      expressions_(lexer_, emitter_, names_, faults_),
      blocks_(emitter_, faults_),
      read_part_(context.read_part) {
  program_.name = name_of_file(context.file);
  program_.language = "srcl";
  program_.file = context.file;
}

std::shared_ptr<const Program> Parser::run(Diagnostics& diagnostics) {
  while (lexer_.token().kind != TokenKind::end_of_text) {
    read_line();
    if (program_.statements.size() > kMostStatements) {
      faults_.add(lexer_.token(), fmt::format("the program has more than {} statements", kMostStatements),
                  "divide it into several programs");
      break;
    }
  }
  blocks_.finish();
  faults_.move_to(diagnostics);
  const bool faulty = faults_.count() > 0;
  if (faulty && read_part_ == nullptr) return nullptr;
  Diagnostics last;  // bounds that only the whole program shows
  if (!faulty) check_program(program_, last);
  diagnostics.take(last);
  auto program = std::make_shared<const Program>(std::move(program_));
  if (read_part_ != nullptr) *read_part_ = program;
  return !faulty && last.ok() ? program : nullptr;
}

void Parser::read_line() {
  const bool readable = read_statement();
  if (readable && !lexer_.at_end_of_line()) {
    faults_.add(lexer_.token(), fmt::format("{} is surplus here", shown(lexer_.token())),
                "end the line before it; one statement per line");
  }
  while (!lexer_.at_end_of_line()) lexer_.advance();
  flush_scripts();
  if (lexer_.token().kind == TokenKind::end_of_line) lexer_.advance();
}

// Up to the end of the line, if all is well.
bool Parser::read_statement() {
  while (!lexer_.at_end_of_line()) {
    const Token first = lexer_.token();
    lexer_.advance();
    if (first.kind == TokenKind::keyword) return statement(first);
    if (first.kind != TokenKind::name) {
      faults_.add(first, fmt::format("no statement begins with {}", shown(first)),
                  "begin it with a keyword or the name of a variable; comments begin with ';'");
      return false;
    }
    const Sign sign = lexer_.token().sign;
    if (sign != Sign::colon) {
      if (sign == Sign::equal || sign == Sign::open || sign == Sign::dot) return assign(first);
      return unknown_statement(first);
    }
    lexer_.advance();
    statement_seen_ = true;
    if (belongs_to_routine(first)) blocks_.label(first);
  }
  return true;
}

bool Parser::statement(const Token& at) {
  switch (at.keyword) {
    case Keyword::program:
    case Keyword::integer:
    case Keyword::real:
    case Keyword::boolean:
    case Keyword::pose:
    case Keyword::joints:
    case Keyword::constant:
    case Keyword::list:
    case Keyword::semaphore:
      return declaration(at);
    case Keyword::subprogram:
      return subprogram(at);
    case Keyword::subprogram_end:
      blocks_.end_subprogram(at);
      return true;
    default:
      break;
  }
  statement_seen_ = true;
  if (!belongs_to_routine(at)) return false;
  if (const std::optional<bool> readable = motion_statement(at)) return *readable;
  if (const std::optional<bool> readable = block_statement(at)) return *readable;
  if (const std::optional<bool> readable = flow_statement(at)) return *readable;
  if (const std::optional<bool> readable = signal_statement(at)) return *readable;
  faults_.add(at, fmt::format("no statement begins with {}", shown(at)),
              "begin it with another word; names must differ from keywords");
  return false;
}

bool Parser::declaration(const Token& at) {
  if (blocks_.innermost() != nullptr || blocks_.has_subprograms()) {
    faults_.add(at, fmt::format("{} is not allowed in a block or after a subprogram", shown(at)),
                "declare it in the main program, outside blocks");
  }
  switch (at.keyword) {
    case Keyword::program:
      return program_name(at);
    case Keyword::constant:
      return declare_constants();
    case Keyword::list:
      return declare_list();
    case Keyword::semaphore:
      return declare_semaphore();
    case Keyword::integer:
      return declare_variables(ValueType::integer);
    case Keyword::real:
      return declare_variables(ValueType::real);
    case Keyword::boolean:
      return declare_variables(ValueType::boolean);
    case Keyword::pose:
      return declare_variables(ValueType::pose);
    default:
      return declare_variables(ValueType::joints);
  }
}

// Statements after a subprogram and outside any are never executed.
bool Parser::belongs_to_routine(const Token& at) {
  if (!blocks_.has_subprograms() || blocks_.in_subprogram()) return true;
  if (!told_stray_) {
    told_stray_ = true;
    faults_.add(at, "statements after a subprogram do not belong to one",
                "put them before the first UPRO, or into a subprogram");
  }
  return false;
}

bool Parser::unknown_statement(const Token& name) {
  std::string remedy = faults_.proposal(name.text, statement_words(), {});
  if (remedy.empty()) {
    remedy = names_.find(name.text) != nullptr ? "write '=' after the name of a variable"
                                               : "begin with a keyword, or 'NAME =' or 'NAME:'";
  }
  faults_.add(name, fmt::format("no statement begins with {}", shown(name)), std::move(remedy));
  recover_block(name);
  return false;
}

// A misspelt word that begins or ends a block is taken for it, so that its counterpart is not wrong as well.
void Parser::recover_block(const Token& name) {
  if (faults_.count() > Diagnostics::kKept) return;
  const std::vector<std::string> words = nearest(name.text, statement_words(), 1);
  if (words.empty()) return;
  switch (const Keyword meant = find_keyword(words.front())) {
    case Keyword::if_begin:
    case Keyword::while_begin:
    case Keyword::count_begin:
    case Keyword::repeat_begin:
    case Keyword::loop_begin:
      blocks_.open(meant, name);
      return;
    case Keyword::if_end:
      close_misspelt(Keyword::if_begin, name);
      return;
    case Keyword::while_end:
      close_misspelt(Keyword::while_begin, name);
      return;
    case Keyword::count_end:
      close_misspelt(Keyword::count_begin, name);
      return;
    case Keyword::loop_end:
      close_misspelt(Keyword::loop_begin, name);
      return;
    case Keyword::subprogram_end:
      if (blocks_.in_subprogram()) blocks_.end_subprogram(name);
      return;
    default:
      return;
  }
}

void Parser::close_misspelt(Keyword begin, const Token& name) {
  if (blocks_.innermost() != nullptr && blocks_.find_to_close(begin, name) != nullptr) blocks_.close();
}

bool Parser::assign(const Token& name) {
  statement_seen_ = true;
  if (!belongs_to_routine(name)) return false;
  const Declared* const declared = expressions_.find(name);
  if (declared == nullptr) {
    recover_block(name);
    return false;
  }
  if (declared->kind == Declared::Kind::constant || declared->kind == Declared::Kind::semaphore) {
    const bool constant = declared->kind == Declared::Kind::constant;
    faults_.add(name, fmt::format("{} is {} and cannot be set", shown(name), constant ? "constant" : "a semaphore"),
                constant ? fmt::format("declare it without FEST in line {}", declared->line)
                         : "write BELEGE or FREI before it");
    return false;
  }
  ExpressionId index = kNoExpression;
  if (declared->kind == Declared::Kind::list) {
    const std::optional<Operand> read = expressions_.read_index(*declared);
    if (!read) return false;
    if (read->known()) index = emitter_.expression(*read);
  } else if (lexer_.token().sign == Sign::open) {
    expressions_.report_no_list(name);
    return false;
  }
  std::uint32_t component = kNone;
  double factor = 1;
  if (lexer_.token().sign == Sign::dot) {
    const std::optional<Component> read = expressions_.read_component(declared->type);
    if (!read) return false;
    component = read->index;
    factor = read->si_factor;
  }
  if (!expressions_.expect(Sign::equal, "=")) return false;
  std::optional<Operand> value = expressions_.read(component == kNone ? declared->type : ValueType::real,
                                                   fmt::format("the value of {}", name.text));
  if (value && factor != 1) value = emitter_.real(*value, factor);
  return store(name, *declared, index, component, value);
}

bool Parser::store(const Token& name, const Declared& declared, ExpressionId index, std::uint32_t component,
                   std::optional<Operand> value) {
  if (!value) return false;
  if (!value->known()) return true;
  AssignStatement assignment;
  assignment.variable = declared.variable;
  assignment.index = index;
  assignment.component = component;
  assignment.value = emitter_.expression(*value);
  emitter_.add(assignment, name);
  return true;
}

void Parser::flush_scripts() {
  if (lexer_.scripts().empty()) return;
  for (const ScriptComment& comment : lexer_.scripts()) {
    Token at;
    at.line = comment.line;
    at.column = comment.column;
    const std::string_view command = script_command(comment.text);
    if (command.empty()) {
      faults_.add(at, kScriptCommentWithoutCommand, kScriptCommentRemedy);
    } else if (belongs_to_routine(at)) {
      emitter_.add(ScriptStatement{emitter_.text(command)}, at);
    }
  }
  lexer_.scripts().clear();
}

}  // namespace cellmirror::program::srcl
