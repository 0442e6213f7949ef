// Reads modules statement by statement and writes the statements of the machine. One pass; calls find their procedures
// at the end.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "scripts/programs/program/language.hpp"
#include "scripts/programs/program/program_builder.hpp"
#include "scripts/programs/rapid/expressions.hpp"
#include "scripts/programs/rapid/lexer.hpp"
#include "scripts/programs/rapid/names.hpp"

namespace cellmirror::program::rapid {

class Parser {
 public:
  Parser(std::string_view text, const ParseContext& context);
  // Call it once. Null after an error, which is reported.
  std::shared_ptr<const Program> run(Diagnostics& diagnostics);

  struct Instruction {
    std::string_view word;               // as people write it
    bool (Parser::*read)(const Token&);  // reads what follows the word, without the semicolon
  };
  // All of them; also for the test of the documentation.
  [[nodiscard]] static std::vector<std::string_view> instructions();

 private:
  // What ends a block, by its kind.
  static constexpr std::array<std::string_view, 4> kBlockEnds = {"ENDIF", "a statement", "ENDFOR", "ENDWHILE"};

  using Label = ProgramBuilder::Label;
  enum class BlockKind : std::uint8_t { if_then, if_short, for_do, while_do };
  struct Block {
    BlockKind kind = BlockKind::if_then;
    Token at;
    Label top;   // of loops
    Label skip;  // where a false condition leads to
    Label end;   // behind the block
    bool has_else = false;
    VariableId counter = kNone;
    VariableId step = kNone;  // where it is not constant
    double step_value = 1;
  };
  struct Procedure {
    Label label;
    std::uint32_t line = 0;    // 0: called, and not read yet
    std::vector<Token> calls;  // before it is read
  };
  static const std::vector<Instruction>& all_instructions();

  // Each of these reads something after its first word `at`. False: the rest of the statement cannot be read, which has
  // been reported.
  void read_item();
  bool structure(const Token& at);
  bool statement(const Token& at);
  bool unknown_statement(const Token& at);
  void recover();
  void end_statement(const Token& at, bool readable);
  void flush_scripts();
  bool belongs_to_procedure(const Token& at);
  void add(const Token& at, const Statement& statement);
  void mark(const Token& at) { builder_.at(at.line, at.column); }

  bool begin_module(const Token& at);
  void end_module(const Token& at);
  bool begin_procedure(const Token& at);
  void declare_parameters();
  void end_procedure(const Token& at);
  bool skip_routine(const Token& at, std::string_view end);
  bool call(const Token& name);
  Procedure& procedure(std::string_view name);
  void finish_calls();
  void write_entry();

  // declarations.cpp
  enum class Keeps : std::uint8_t { constant, persistent, variable };
  bool declaration(const Token& at);
  bool declare_one(Keeps keeps, const Token& type_name);
  bool refuse_type(const Token& type_name);
  void declare(const Token& name, Type type, Keeps keeps, std::optional<Value> initial, bool valid);
  bool declare_speed(const Token& name);
  bool new_name(const Token& name);
  bool assign(const Token& name);

  // flow.cpp
  bool block_word(const Token& at);
  bool begin_if(const Token& at);
  bool else_branch(const Token& at);
  bool begin_while(const Token& at);
  bool begin_for(const Token& at);
  bool begin_rounds(const Token& name, Block& block, const Operand& first, const Operand& last,
                    std::optional<double> known_step, const std::optional<Operand>& step);
  VariableId hidden(const Token& at, std::string_view what, ExpressionId value);
  void end_block(const Token& at);
  Block& open(BlockKind kind, const Token& at);
  void close();
  void close_short_if();
  bool find_to_close(BlockKind kind, const Token& at);
  void branch(Block& block, const std::optional<Operand>& condition, const Token& at);
  bool stop(const Token& at);
  bool exit_program(const Token& at);
  bool return_back(const Token& at);

  // motions.cpp
  bool move_joints_absolute(const Token& at);
  bool move_joints(const Token& at);
  bool move_linear(const Token& at);
  bool move(const Token& at, PathKind path, Type target_type);
  std::optional<Zone> read_zone(bool& known);
  bool read_frame(std::string_view type, std::string_view only);
  bool refuse_switches(bool work_object_allowed);
  void skip_switch_value();
  void set_speed(PathKind path, const Speed& speed, const Token& at);
  void set(Setting setting, std::optional<double> value, const Token& at);

  // signals.cpp
  bool set_output(const Token& at);
  bool set_on(const Token& at);
  bool set_off(const Token& at);
  bool switch_output(const Token& at, bool on);
  bool wait_time(const Token& at);
  bool wait_input(const Token& at);
  bool wait_options(WaitStatement& statement);
  bool write_text(const Token& at);

  static constexpr std::size_t kMostNested = 64;  // blocks within each other

  const ParseContext& context_;
  Diagnostics found_;
  Lexer lexer_;
  ProgramBuilder builder_;
  Names names_;
  ExpressionReader values_;
  std::unordered_map<std::string, Procedure> procedures_;  // keys in lower case
  std::vector<std::string> procedure_order_;               // as they are met, so that errors come in that order
  std::vector<Block> blocks_;
  Label entry_;
  std::optional<Token> module_;
  std::optional<Token> procedure_;
  bool named_ = false;
  bool uses_tool_ = false;
  bool told_stray_ = false;
  bool told_depth_ = false;
};

}  // namespace cellmirror::program::rapid
