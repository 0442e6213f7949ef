#include "scripts/programs/rapid/parser.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace cellmirror::program::rapid {

Parser::Parser(std::string_view text, const ParseContext& context)
    : context_(context),
      lexer_(text),
      builder_(name_of_file(context.file), "rapid", context.file),
      values_(lexer_, builder_, names_, context.file, found_),
      entry_(builder_.new_label()) {}

std::shared_ptr<const Program> Parser::run(Diagnostics& diagnostics) {
  builder_.at(1, 1);
  builder_.jump(entry_);
  while (!lexer_.at_end()) read_item();
  flush_scripts();
  if (procedure_) {
    values_.error(*procedure_, fmt::format("PROC {} is not closed", procedure_->text), "write ENDPROC at its end");
    end_procedure(lexer_.token());
  }
  if (module_) {
    values_.error(*module_, fmt::format("MODULE {} is not closed", module_->text), "write ENDMODULE at its end");
  }
  write_entry();
  auto program = builder_.build(found_, context_.read_part);
  diagnostics.take(found_);
  return program;
}

const std::vector<Parser::Instruction>& Parser::all_instructions() {
  static const std::vector<Instruction> instructions = {
      {"MoveAbsJ", &Parser::move_joints_absolute},
      {"MoveJ", &Parser::move_joints},
      {"MoveL", &Parser::move_linear},
      {"SetDO", &Parser::set_output},
      {"Set", &Parser::set_on},
      {"Reset", &Parser::set_off},
      {"WaitTime", &Parser::wait_time},
      {"WaitDI", &Parser::wait_input},
      {"TPWrite", &Parser::write_text},
      {"Stop", &Parser::stop},
      {"EXIT", &Parser::exit_program},
      {"RETURN", &Parser::return_back},
  };
  return instructions;
}

std::vector<std::string_view> Parser::instructions() {
  std::vector<std::string_view> words;
  for (const Instruction& instruction : all_instructions()) words.push_back(instruction.word);
  return words;
}

// What ends or begins more than a statement: reading goes on there after an error.
namespace {

constexpr auto kStructure = std::to_array<std::string_view>({"MODULE", "ENDMODULE", "PROC", "ENDPROC", "FUNC", "TRAP",
                                                             "RECORD", "LOCAL", "CONST", "PERS", "VAR", "IF", "ELSEIF",
                                                             "ELSE", "ENDIF", "FOR", "ENDFOR", "WHILE", "ENDWHILE"});

bool is_structure(const Token& token) {
  if (token.kind != TokenKind::word) return false;
  return std::ranges::any_of(kStructure, [&](std::string_view word) { return token.is(word); });
}

}  // namespace

// Behind the next semicolon, or before a word of the structure that begins a line.
void Parser::recover() {
  while (!lexer_.at_end()) {
    if (lexer_.at(Sign::semicolon)) return lexer_.advance();
    if (lexer_.token().begins_line && is_structure(lexer_.token())) return;
    lexer_.advance();
  }
}

void Parser::read_item() {
  flush_scripts();
  const Token first = lexer_.token();
  lexer_.advance();
  if (first.sign == Sign::semicolon) return;
  if (first.kind != TokenKind::word) {
    std::string_view remedy = "begin it with an instruction or a name; comments begin with '!'";
    if (first.kind == TokenKind::bad_text) remedy = "end the text in its line";
    if (first.text == "%") remedy = "end the header of the file by %%%, or delete it";
    values_.error(first, fmt::format("no statement begins with {}", shown(first)), std::string(remedy));
    return recover();
  }
  if (is_structure(first)) {
    if (!structure(first)) recover();
    return;
  }
  const bool in_short_if = !blocks_.empty() && blocks_.back().kind == BlockKind::if_short;
  mark(first);
  end_statement(first, statement(first));
  if (in_short_if) close_short_if();
}

bool Parser::structure(const Token& at) {
  if (at.is("MODULE")) return begin_module(at);
  if (at.is("ENDMODULE")) {
    end_module(at);
    return true;
  }
  if (at.is("PROC")) return begin_procedure(at);
  if (at.is("ENDPROC")) {
    if (procedure_) {
      end_procedure(at);
    } else {
      values_.error(at, "ENDPROC has no PROC before it", "delete it, or write PROC and a name before the procedure");
    }
    return true;
  }
  if (at.is("FUNC")) return skip_routine(at, "ENDFUNC");
  if (at.is("TRAP")) return skip_routine(at, "ENDTRAP");
  if (at.is("RECORD")) return skip_routine(at, "ENDRECORD");
  if (at.is("LOCAL")) {  // names of all modules are one here: it makes no difference
    if (is_structure(lexer_.token())) return true;
    values_.error(lexer_.token(), fmt::format("LOCAL is followed by {}", shown(lexer_.token())),
                  "write CONST, PERS, VAR or PROC behind it");
    return false;
  }
  if (at.is("CONST") || at.is("PERS") || at.is("VAR")) return declaration(at);
  mark(at);
  if (!belongs_to_procedure(at)) return false;
  return block_word(at);
}

bool Parser::statement(const Token& at) {
  if (lexer_.at(Sign::becomes) || lexer_.at(Sign::dot) || lexer_.at(Sign::open_index)) {
    return belongs_to_procedure(at) && assign(at);
  }
  for (const Instruction& instruction : all_instructions()) {
    if (equal_ignoring_case(at.text, instruction.word)) {
      return belongs_to_procedure(at) && (this->*instruction.read)(at);
    }
  }
  if (!belongs_to_procedure(at)) return false;
  if (lexer_.at(Sign::semicolon) && instead_of(at.text).empty()) return call(at);
  return unknown_statement(at);
}

bool Parser::unknown_statement(const Token& at) {
  const std::string_view instead = instead_of(at.text);
  if (!instead.empty()) {
    values_.error(at, fmt::format("{} is not in the subset", shown(at)), std::string(instead));
    return false;
  }
  if (procedures_.contains(lower_case(at.text))) {
    values_.error(lexer_.token(), fmt::format("{} is called with arguments", shown(at)),
                  "procedures have no parameters here: hand values over in data of the module");
    return false;
  }
  std::vector<std::string> words;
  for (const std::string_view word : instructions()) words.emplace_back(word);
  values_.error(
      at, fmt::format("{} is not an instruction of the subset", shown(at)),
      values_.proposal(at.text, words,
                       "docs/languages/rapid.md lists the instructions; procedures are called without arguments"));
  return false;
}

void Parser::end_statement(const Token& at, bool readable) {
  if (!readable) return recover();
  if (lexer_.at(Sign::semicolon)) return lexer_.advance();
  values_.error(lexer_.token(), fmt::format("';' is missing before {}", shown(lexer_.token())),
                fmt::format("end the statement of line {} with ';'", at.line));
  // The next line is likely to be a statement of its own.
  if (!lexer_.token().begins_line) recover();
}

bool Parser::belongs_to_procedure(const Token& at) {
  if (procedure_) return true;
  if (!std::exchange(told_stray_, true)) {
    values_.error(at, fmt::format("{} is outside a procedure", shown(at)), "write it between PROC and ENDPROC");
  }
  return false;
}

void Parser::add(const Token& at, const Statement& statement) {
  mark(at);
  if (const Result<void> added = builder_.add(statement); !added) values_.error(at, added.error());
}

void Parser::flush_scripts() {
  if (lexer_.scripts().empty()) return;
  for (const ScriptComment& comment : lexer_.scripts()) {
    Token at;
    at.line = comment.line;
    at.column = comment.column;
    at.text = comment.text;
    at.kind = TokenKind::word;
    const std::string_view command = script_command(comment.text);
    if (command.empty()) {
      values_.error(at, kScriptCommentWithoutCommand, kScriptCommentRemedy);
    } else if (belongs_to_procedure(at)) {
      add(at, ScriptStatement{builder_.text(command)});
    }
  }
  lexer_.scripts().clear();
}

bool Parser::begin_module(const Token& at) {
  if (module_) {
    values_.error(at, fmt::format("MODULE {} of line {} is not closed", module_->text, module_->line),
                  "write ENDMODULE before this line");
  }
  const Token name = lexer_.token();
  module_ = at;
  if (name.kind != TokenKind::word) {
    values_.error(name, "the name of the module is missing", "write MODULE and a name");
    return false;
  }
  module_ = name;
  lexer_.advance();
  if (!std::exchange(named_, true)) builder_.rename(std::string(name.text));
  if (!lexer_.at(Sign::open)) return true;
  while (!lexer_.at_end() && !lexer_.at(Sign::close)) lexer_.advance();  // attributes: SYSMODULE, NOSTEPIN, ...
  return values_.expect(Sign::close, ")");
}

void Parser::end_module(const Token& at) {
  if (procedure_) {
    values_.error(*procedure_, fmt::format("PROC {} is not closed", procedure_->text), "write ENDPROC at its end");
    end_procedure(at);
  }
  if (!module_) values_.error(at, "ENDMODULE has no MODULE before it", "write MODULE and a name at the beginning");
  module_.reset();
  told_stray_ = false;
}

Parser::Procedure& Parser::procedure(std::string_view name) {
  const auto [at, fresh] = procedures_.try_emplace(lower_case(name));
  if (fresh) {
    at->second.label = builder_.new_label();
    procedure_order_.push_back(at->first);
  }
  return at->second;
}

bool Parser::begin_procedure(const Token& at) {
  if (procedure_) {
    values_.error(at, fmt::format("PROC {} of line {} is not closed", procedure_->text, procedure_->line),
                  "write ENDPROC before this line");
    end_procedure(at);
  }
  if (!module_) {
    values_.error(at, "PROC is outside a module", "write MODULE and a name before it, and ENDMODULE at the end");
    module_ = at;
  }
  const Token name = lexer_.token();
  procedure_ = name.kind == TokenKind::word ? name : at;
  names_.begin_procedure();
  told_stray_ = false;
  if (name.kind != TokenKind::word) {
    values_.error(name, "the name of the procedure is missing", "write PROC and a name");
    return false;
  }
  lexer_.advance();
  Procedure& made = procedure(name.text);
  if (made.line != 0) {
    values_.error(name, fmt::format("PROC {} exists already, in line {}", name.text, made.line),
                  "give one of the two another name");
  } else {
    made.line = name.line;
    builder_.bind(made.label);
  }
  if (!values_.expect(Sign::open, "(")) return false;
  if (!lexer_.at(Sign::close)) declare_parameters();
  return values_.expect(Sign::close, ")");
}

// They are not in the subset: reported once, and not again where they are used.
void Parser::declare_parameters() {
  values_.error(lexer_.token(), fmt::format("PROC {} has parameters", procedure_->text),
                "procedures have no parameters here: hand values over in data of the module");
  while (!lexer_.at_end() && !lexer_.at(Sign::close)) {
    if (lexer_.token().kind == TokenKind::word) names_.forgive(lexer_.token().text);
    lexer_.advance();
  }
}

void Parser::end_procedure(const Token& at) {
  while (!blocks_.empty()) {
    const Block& block = blocks_.back();
    values_.error(block.at, fmt::format("{} is not closed before {} in line {}", shown(block.at), shown(at), at.line),
                  fmt::format("write {} after its statements", kBlockEnds.at(static_cast<std::size_t>(block.kind))));
    close();
  }
  add(at, ReturnStatement{});
  procedure_.reset();
  names_.end_procedure();
}

// FUNC, TRAP and RECORD, as a whole.
bool Parser::skip_routine(const Token& at, std::string_view end) {
  values_.error(at, fmt::format("{} is not in the subset", shown(at)),
                at.is("FUNC") ? "write a PROC that leaves its result in data of the module"
                              : "delete it, or write it with PROC and data of the module");
  while (!lexer_.at_end() && !lexer_.at(end) && !lexer_.at("ENDMODULE")) lexer_.advance();
  if (lexer_.at(end)) lexer_.advance();
  lexer_.scripts().clear();
  return true;
}

bool Parser::call(const Token& name) {
  Procedure& called = procedure(name.text);
  if (called.line == 0) called.calls.push_back(name);
  builder_.call(called.label);
  return true;
}

// The first statement leads here: what the text needs is known now.
void Parser::write_entry() {
  builder_.at(1, 1);
  builder_.bind(entry_);
  if (uses_tool_) {  // tool0: the TCP is the origin of the flange
    if (const auto added = builder_.add(SetStatement{Setting::tool, builder_.constant(Pose::Identity())}); !added) {
      found_.error({.file = context_.file}, added.error().what);
    }
  }
  Procedure& main = procedure("main");
  if (main.line == 0) {
    found_.error({.file = context_.file}, "there is no PROC main()", "name the procedure that begins 'main'");
  }
  builder_.call(main.label);
  finish_calls();  // labels that are nowhere lead to the end
  if (const auto added = builder_.add(EndStatement{}); !added) {
    found_.error({.file = context_.file}, added.error().what);
  }
}

void Parser::finish_calls() {
  std::vector<std::string> names;
  for (const std::string& name : procedure_order_) {
    if (procedures_.at(name).line != 0) names.push_back(name);
  }
  for (const std::string_view word : instructions()) names.emplace_back(word);
  for (const std::string& name : procedure_order_) {
    const Procedure& wanted = procedures_.at(name);
    if (wanted.line != 0) continue;
    for (const Token& at : wanted.calls) {
      values_.error(at, fmt::format("there is no PROC or instruction {} in the subset", shown(at)),
                    values_.proposal(at.text, names, fmt::format("write 'PROC {}()' ... 'ENDPROC'", at.text)));
    }
    builder_.bind(wanted.label);
  }
}

}  // namespace cellmirror::program::rapid
