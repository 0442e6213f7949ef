// Turns records into statements, line by line, in one pass.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "scripts/programs/irdata/code_table.hpp"
#include "scripts/programs/irdata/cursor.hpp"
#include "scripts/programs/irdata/expression_reader.hpp"
#include "scripts/programs/irdata/findings.hpp"
#include "scripts/programs/irdata/jumps.hpp"
#include "scripts/programs/irdata/operations.hpp"
#include "scripts/programs/irdata/symbols.hpp"
#include "scripts/programs/irdata/terms.hpp"
#include "scripts/programs/program/language.hpp"

namespace cellmirror::program::irdata {

inline constexpr std::size_t kLongestLine = 8192;  // bytes
inline constexpr std::size_t kMostBlocks = 64;     // within each other
inline constexpr std::uint32_t kGreatestRecord = 99'999'999;
inline constexpr std::int64_t kGreatestIndex = 1'000'000'000;  // of lists, and the negative of it the least

class Translator {
 public:
  // `codes` and the text whose lines follow must outlive this.
  Translator(const ParseContext& context, const CodeTable& codes, Diagnostics& diagnostics);

  // Number of lines that follow: memory is reserved at once.
  void expect_lines(std::size_t lines);
  // The next line, without its end.
  void read_line(std::string_view text);
  // Too many records: the rest of the text is not worth reading.
  [[nodiscard]] bool cancelled() const { return cancelled_; }
  // As ProgramBuilder::build().
  std::shared_ptr<const Program> finish(std::shared_ptr<const Program>* read_part);

 private:
  enum class Section : std::uint8_t { before, header, main, behind_end, subprogram };

  struct Block {
    Operation kind = Operation::if_begin;
    std::uint32_t line = 0;
    std::uint32_t column = 0;
    std::uint32_t id = 0;         // for Jumps
    std::uint32_t outside = 0;    // id of the block around it
    ProgramBuilder::Label begin;  // of a loop
    ProgramBuilder::Label end;
    ProgramBuilder::Label next;  // of IF: where it continues if the condition is false
    bool open_next = false;
    bool is_else = false;
    std::uint32_t counter = kNone;  // of FOR: its variable
    std::int64_t step = 1;
  };
  struct List {
    std::string_view name;
    ValueType type = ValueType::real;
    std::uint32_t line = 0;
    std::uint32_t column = 0;
    std::int64_t first = 1;
    std::optional<std::int64_t> last;
    std::vector<Value> values;
    bool good = true;  // else it has been reported
  };

  // records.cpp: the frame of a record
  void read_number();
  bool read_operation();
  std::string remedy_for(std::string_view name);  // of an operation that there is not
  bool section_allows();
  bool leave_wrong_section();
  void execute_record();
  void read_comment(std::string_view text, std::uint32_t column);
  [[nodiscard]] Spot spot(std::uint32_t column) const;

  // parameters.cpp
  bool next_parameter();
  bool require_parameter();
  void end_parameter();
  void finish_parameters();
  Term value_parameter();
  Term typed_parameter(std::string_view what, ValueType type);
  Term constant_parameter(std::string_view what);
  Term port_parameter();
  AssignTarget target_parameter();
  bool word_parameter(Word word);  // false: it does not come next
  std::string_view name_parameter(std::string_view what);
  std::string_view free_text();
  std::optional<ProgramBuilder::Label> jump_parameter();
  Term checked(const Term& term, std::string_view what, ValueType type);
  void add(const Statement& statement, std::uint32_t column);
  void refuse(std::uint32_t column, const Error& error);

  // header.cpp
  void header_record();
  void declaration_record();
  void declare_variable(ValueType type);
  void declare_constant();
  void declare_list();
  void read_list_bounds(List& list);
  void read_data();
  void declare_semaphore();
  std::string_view new_name(std::string_view what);
  void end_header();

  // motion.cpp
  void motion_record();
  void setting_record();
  void fly_record();
  Term scaled_setting(std::string_view what, double greatest, double factor);

  // flow.cpp
  void flow_record();
  void jump_record();
  void jump_on_record();
  void subprogram_record();
  void end_section();
  // blocks.cpp
  void block_record();
  Block& open_block(Operation kind);
  Block* innermost(Operation kind);
  void close_block();
  void branch(const Term& condition, ProgramBuilder::Label otherwise);  // on where it holds
  void begin_if();
  void continue_if();
  void end_if();
  void begin_while();
  void begin_for();
  void end_for();
  void begin_loop();
  void end_loop();
  void exit_loop();

  // arithmetic.cpp
  void arithmetic_record();
  void assign(const AssignTarget& target, const Term& value);
  void step_record();
  void shift_record();
  Term operation_result();
  VariableId hidden_variable(ValueType type);
  void assign_hidden(VariableId variable, const Term& value);

  // signals.cpp
  void signal_record();
  Term duration_parameter();
  void output_record();
  void pulse_record();
  void wait_record();
  Term input_condition(std::string& text);
  void finish_wait(const Term& condition, const std::string& text);
  void semaphore_record();

  const CodeTable& codes_;
  Findings findings_;
  Diagnostics& diagnostics_;
  ProgramBuilder builder_;
  Terms terms_;
  Symbols symbols_;
  ExpressionReader reader_;
  Jumps jumps_;
  std::vector<List> lists_;
  std::size_t list_elements_ = 0;
  std::unordered_map<std::string_view, std::uint32_t> semaphores_;  // name to line
  std::vector<Block> blocks_;
  std::uint32_t block_ = 0;  // id of the innermost one
  std::uint32_t scope_ = 0;  // 0: main section, else number of the subprogram
  std::uint32_t subprograms_ = 0;
  std::uint32_t hidden_ = 0;
  std::uint32_t timed_out_ = kNone;  // hidden variable of waits with a label
  Section section_ = Section::before;
  Spot subprogram_spot_;
  bool strayed_ = false;  // records behind END were reported
  bool cancelled_ = false;

  // The record that is being read.
  Cursor cursor_;
  std::uint32_t line_ = 0;
  std::uint32_t last_number_ = 0;
  std::uint32_t number_ = 0;
  bool numbered_ = false;
  bool any_number_ = false;
  std::size_t records_ = 0;
  std::uint32_t column_ = 0;            // of the record
  std::uint32_t operation_column_ = 0;  // of its operation
  Operation operation_ = Operation::comment;
  std::size_t parameter_begin_ = 0;
  bool incomplete_ = false;  // a missing parameter was reported
};

}  // namespace cellmirror::program::irdata
