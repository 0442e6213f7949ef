// Labels, jumps, subprograms, and the ends of sections.
#include <fmt/format.h>

#include "scripts/programs/irdata/translator.hpp"

namespace cellmirror::program::irdata {

void Translator::flow_record() {
  switch (operation_) {
    case Operation::label: {
      const std::uint32_t column = operation_column_;
      const std::string_view name = name_parameter("the name of the label");
      if (!name.empty()) jumps_.define_label(name, spot(column));
      return;
    }
    case Operation::jump:
    case Operation::jump_if:
      return jump_record();
    case Operation::jump_on:
      return jump_on_record();
    case Operation::call:
    case Operation::subprogram:
    case Operation::end_subprogram:
    case Operation::return_back:
      return subprogram_record();
    case Operation::pause:
      return add(PauseStatement{}, operation_column_);
    case Operation::stop:
      return add(EndStatement{}, operation_column_);
    case Operation::end:
      if (section_ == Section::subprogram) {
        findings_.error(operation_column_, "END is in a subprogram",
                        "close the subprogram with END_SUBPROGRAM; STOP ends the program from anywhere");
        return;
      }
      end_section();
      add(EndStatement{}, operation_column_);
      section_ = Section::behind_end;
      strayed_ = false;
      return;
    default:
      return block_record();
  }
}

void Translator::jump_record() {
  Term condition;
  if (operation_ == Operation::jump_if) condition = typed_parameter("a condition", ValueType::boolean);
  const auto label = jump_parameter();
  if (!label) return;
  if (operation_ == Operation::jump) return builder_.jump(*label);
  if (!condition.known) return;
  const Term stay = terms_.apply(Operator::logical_not, condition.column, {condition});
  if (!stay.known) return;
  if (const auto made = builder_.branch_unless(terms_.id(stay), *label); !made) refuse(condition.column, made.error());
}

// 1 leads to the first label, 2 to the second, ...; anything else continues with the next record.
void Translator::jump_on_record() {
  const Term which = typed_parameter("the label selector", ValueType::integer);
  const VariableId chosen = hidden_variable(ValueType::integer);
  if (which.known) assign_hidden(chosen, which);
  std::int64_t number = 0;
  do {
    const auto label = jump_parameter();
    if (incomplete_) return;
    ++number;
    cursor_.skip_blank();
    if (!label) continue;
    const Term stay =
        terms_.apply(Operator::not_equal, operation_column_,
                     {terms_.variable(chosen, operation_column_), integer_literal(number, operation_column_)});
    if (!stay.known) continue;
    if (const auto made = builder_.branch_unless(terms_.id(stay), *label); !made)
      refuse(operation_column_, made.error());
  } while (!cursor_.at_end());
}

void Translator::subprogram_record() {
  const std::uint32_t column = operation_column_;
  switch (operation_) {
    case Operation::call: {
      const std::string_view name = name_parameter("the name of the subprogram");
      if (!name.empty()) builder_.call(jumps_.to_subprogram(name, spot(column)));
      return;
    }
    case Operation::subprogram: {
      if (section_ == Section::main)
        findings_.error(column, "a subprogram is within the main section", "put it after END");
      if (section_ == Section::subprogram)
        findings_.error_at(subprogram_spot_.line, subprogram_spot_.column, "the subprogram is not closed",
                           "close it with a record END_SUBPROGRAM");
      end_section();
      section_ = Section::subprogram;
      scope_ = ++subprograms_;
      subprogram_spot_ = spot(column);
      const std::string_view name = name_parameter("the name of the subprogram");
      if (!name.empty()) jumps_.define_subprogram(name, subprogram_spot_);
      return;
    }
    case Operation::return_back:
      if (section_ == Section::subprogram) return add(ReturnStatement{}, column);
      findings_.error(column, "RETURN is outside a subprogram", "end the program with STOP");
      return;
    default:
      break;
  }
  if (section_ != Section::subprogram) {
    findings_.error(column, "END_SUBPROGRAM has no SUBPROGRAM", "open a subprogram after END with 'SUBPROGRAM, name'");
    return;
  }
  end_section();
  add(ReturnStatement{}, column);
  section_ = Section::behind_end;
  strayed_ = false;
}

// Blocks that are still open.
void Translator::end_section() {
  for (; !blocks_.empty(); close_block()) {
    const Block& block = blocks_.back();
    findings_.error_at(block.line, block.column, fmt::format("{} is not closed", row_of(block.kind).name),
                       fmt::format("close it with {}", block.kind == Operation::repeat
                                                           ? "UNTIL, condition"
                                                           : fmt::format("END_{}", row_of(block.kind).name)));
  }
}

}  // namespace cellmirror::program::irdata
