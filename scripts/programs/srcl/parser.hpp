// Reads a program of SRCL line by line and writes the statements of the machine. One pass; jumps and calls find their
// targets at the end of their routine and of the text.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "scripts/programs/program/language.hpp"
#include "scripts/programs/srcl/blocks.hpp"
#include "scripts/programs/srcl/emitter.hpp"
#include "scripts/programs/srcl/expressions.hpp"
#include "scripts/programs/srcl/faults.hpp"
#include "scripts/programs/srcl/lexer.hpp"
#include "scripts/programs/srcl/names.hpp"

namespace cellmirror::program::srcl {

class Parser {
 public:
  Parser(std::string_view text, const ParseContext& context);
  // Call it once. Null after an error, which is reported.
  std::shared_ptr<const Program> run(Diagnostics& diagnostics);

 private:
  // Each of these reads a statement after its first word `at`. False: the rest of the line cannot be read, which has
  // been reported.
  void read_line();
  bool read_statement();
  bool statement(const Token& at);
  bool declaration(const Token& at);
  bool unknown_statement(const Token& name);
  void recover_block(const Token& name);
  void close_misspelt(Keyword begin, const Token& name);
  bool assign(const Token& name);
  bool store(const Token& name, const Declared& declared, ExpressionId index, std::uint32_t component,
             std::optional<Operand> value);
  bool belongs_to_routine(const Token& at);
  void flush_scripts();

  // declarations.cpp
  bool program_name(const Token& at);
  bool declare_variables(ValueType type);
  bool declare_constants();
  bool declare_list();
  bool declare_semaphore();
  std::optional<ValueType> read_type();
  std::optional<Token> read_new_name(std::string_view what);
  bool read_list_bounds(Declared& list);
  bool read_list_values(Variable& variable, std::size_t size);
  Value take_value(const Operand& constant, std::size_t constants_before);

  // motions.cpp. As the next three: none where it is another statement.
  std::optional<bool> motion_statement(const Token& at);
  bool move(PathKind path, const Token& at);
  std::optional<Operand> read_target(TargetKind pose_kind, TargetKind joints_kind, TargetKind& kind);
  bool setting(const Token& at);

  // flow.cpp
  std::optional<bool> block_statement(const Token& at);
  std::optional<bool> flow_statement(const Token& at);
  bool begin_if(const Token& at);
  bool else_branch(const Token& at, bool with_condition);
  bool begin_while(const Token& at);
  bool begin_count(const Token& at);
  bool end_loop(Keyword begin, const Token& at);
  bool end_repeat(const Token& at);
  bool leave_loop(const Token& at, bool next_round);
  bool jump(const Token& at);
  bool subprogram(const Token& at);
  bool call(const Token& at);
  std::optional<Token> read_name(std::string_view what);
  ExpressionId read_condition(bool& readable);
  void end_if(const Token& at);

  // signals.cpp
  std::optional<bool> signal_statement(const Token& at);
  bool wait(const Token& at);
  bool wait_for(const Token& at);
  bool wait_limit(WaitStatement& statement, const Token& at, std::optional<Token>& jump_to);
  void check_time(const Token& at, const Operand& seconds);
  bool output(const Token& at, bool analogue);
  bool semaphore(const Token& at, bool acquire);

  Program program_;
  Lexer lexer_;
  Faults faults_;
  Emitter emitter_;
  Names names_;
  ExpressionReader expressions_;
  Blocks blocks_;
  std::shared_ptr<const Program>* read_part_;
  std::size_t list_elements_ = 0;
  bool statement_seen_ = false;
  bool told_stray_ = false;
};

}  // namespace cellmirror::program::srcl
