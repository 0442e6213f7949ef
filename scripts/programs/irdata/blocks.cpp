// IF, WHILE, REPEAT, FOR, LOOP.
#include <fmt/format.h>

#include "scripts/programs/irdata/translator.hpp"

namespace cellmirror::program::irdata {

void Translator::block_record() {
  switch (operation_) {
    case Operation::if_begin:
      return begin_if();
    case Operation::else_if:
    case Operation::else_part:
      return continue_if();
    case Operation::end_if:
      return end_if();
    case Operation::while_begin:
      return begin_while();
    case Operation::end_while:
    case Operation::until:
    case Operation::end_loop:
      return end_loop();
    case Operation::repeat:
      builder_.bind(open_block(Operation::repeat).begin);
      return;
    case Operation::for_begin:
      return begin_for();
    case Operation::end_for:
      return end_for();
    case Operation::loop:
      return begin_loop();
    default:
      return exit_loop();
  }
}

Translator::Block& Translator::open_block(Operation kind) {
  if (blocks_.size() == kMostBlocks) {
    findings_.error(operation_column_, fmt::format("more than {} blocks are nested", kMostBlocks),
                    "use subprograms; the rest of the text was not read");
    cancelled_ = true;
  }
  Block block;
  block.kind = kind;
  block.line = line_;
  block.column = operation_column_;
  block.outside = block_;
  block.id = block_ = jumps_.new_block(block_);
  block.begin = builder_.new_label();
  block.end = builder_.new_label();
  blocks_.push_back(block);
  return blocks_.back();
}

// The innermost block where it is of this kind. Blocks within it that are not closed are reported and closed.
Translator::Block* Translator::innermost(Operation kind) {
  bool any = false;
  for (const Block& block : blocks_) any = any || block.kind == kind;
  if (!any) {
    findings_.error(operation_column_, fmt::format("{} has no matching {}", row_of(operation_).name, row_of(kind).name),
                    fmt::format("open a block with {}, or remove this record", form_of(kind)));
    return nullptr;
  }
  while (blocks_.back().kind != kind) {
    const Block& block = blocks_.back();
    findings_.error(operation_column_,
                    fmt::format("{} comes before the end of {} (line {})", row_of(operation_).name,
                                row_of(block.kind).name, block.line),
                    fmt::format("close it first with {}", block.kind == Operation::repeat
                                                              ? "UNTIL, condition"
                                                              : fmt::format("END_{}", row_of(block.kind).name)));
    close_block();
  }
  return &blocks_.back();
}

void Translator::close_block() {
  const Block& block = blocks_.back();
  if (block.open_next) builder_.bind(block.next);
  builder_.bind(block.end);
  block_ = block.outside;
  blocks_.pop_back();
}

void Translator::branch(const Term& condition, ProgramBuilder::Label otherwise) {
  if (!condition.known) return;
  if (const auto made = builder_.branch_unless(terms_.id(condition), otherwise); !made)
    refuse(condition.column, made.error());
}

void Translator::begin_if() {
  const Term condition = typed_parameter("a condition", ValueType::boolean);
  Block& block = open_block(Operation::if_begin);
  block.next = builder_.new_label();
  block.open_next = true;
  branch(condition, block.next);
}

// ELSE_IF and ELSE.
void Translator::continue_if() {
  Block* block = innermost(Operation::if_begin);
  if (block != nullptr && block->is_else)
    findings_.error(operation_column_,
                    fmt::format("{} comes after ELSE (IF of line {})", row_of(operation_).name, block->line),
                    "ELSE must be the last part of an IF");
  if (block != nullptr) {
    builder_.jump(block->end);
    if (block->open_next) builder_.bind(block->next);
    block->open_next = false;
    block->id = block_ = jumps_.new_block(block->outside);  // no jumps from one part into another
  }
  if (operation_ == Operation::else_part) {
    if (block != nullptr) block->is_else = true;
    return;
  }
  const Term condition = typed_parameter("a condition", ValueType::boolean);
  if (block == nullptr) return;
  block->next = builder_.new_label();
  block->open_next = true;
  branch(condition, block->next);
}

void Translator::end_if() {
  if (innermost(Operation::if_begin) != nullptr) close_block();
}

void Translator::begin_while() {
  Block& block = open_block(Operation::while_begin);
  builder_.bind(block.begin);
  branch(typed_parameter("a condition", ValueType::boolean), block.end);
}

// END_WHILE, UNTIL, END_LOOP.
void Translator::end_loop() {
  const Operation kind = operation_ == Operation::end_while ? Operation::while_begin
                         : operation_ == Operation::until   ? Operation::repeat
                                                            : Operation::loop;
  const Block* block = innermost(kind);
  Term condition;
  if (operation_ == Operation::until) condition = typed_parameter("a condition", ValueType::boolean);
  if (block == nullptr) return;
  if (operation_ == Operation::until)
    branch(condition, block->begin);
  else
    builder_.jump(block->begin);
  close_block();
}

void Translator::begin_for() {
  const AssignTarget counter = target_parameter();
  if (counter.known && (counter.type != ValueType::integer || counter.index != kNoExpression))
    findings_.error(counter.column, "FOR counts with an integer variable", "declare one in the header section");
  const bool good = counter.known && counter.type == ValueType::integer && counter.index == kNoExpression;
  const Term first = typed_parameter("the first value", ValueType::integer);
  const Term last = typed_parameter("the last value", ValueType::integer);
  std::int64_t step = 1;
  cursor_.skip_blank();
  if (!cursor_.at_end() && !incomplete_) {
    const Term term = checked(constant_parameter("the step"), "the step", ValueType::integer);
    const auto value = terms_.constant(term);
    if (value) step = std::get<std::int64_t>(*value);
    if (step == 0) findings_.error(term.column, "the step is 0", "write a positive or a negative one");
  }
  Block& block = open_block(Operation::for_begin);
  if (!good || !first.known || !last.known) {
    builder_.bind(block.begin);
    return;
  }
  block.counter = counter.variable;
  block.step = step;
  assign(counter, first);
  Term limit = last;
  if (!terms_.constant_number(last)) {  // what it was in the beginning counts
    const VariableId kept = hidden_variable(ValueType::integer);
    assign_hidden(kept, last);
    limit = terms_.variable(kept, last.column);
  }
  builder_.bind(block.begin);
  branch(terms_.apply(step > 0 ? Operator::less_equal : Operator::greater_equal, last.column,
                      {terms_.variable(counter.variable, counter.column), limit}),
         block.end);
}

void Translator::end_for() {
  const Block* block = innermost(Operation::for_begin);
  if (block == nullptr) return;
  if (block->counter != kNone)
    assign_hidden(block->counter, terms_.apply(Operator::add, operation_column_,
                                               {terms_.variable(block->counter, operation_column_),
                                                integer_literal(block->step, operation_column_)}));
  builder_.jump(block->begin);
  close_block();
}

// Endless without a parameter.
void Translator::begin_loop() {
  cursor_.skip_blank();
  if (cursor_.at_end()) {
    builder_.bind(open_block(Operation::loop).begin);
    return;
  }
  const Term times = typed_parameter("the number of loop passes", ValueType::integer);
  Block& block = open_block(Operation::loop);
  const VariableId left = hidden_variable(ValueType::integer);
  if (times.known) assign_hidden(left, times);
  builder_.bind(block.begin);
  const std::uint32_t column = operation_column_;
  branch(terms_.apply(Operator::greater, column, {terms_.variable(left, column), integer_literal(0, column)}),
         block.end);
  assign_hidden(left,
                terms_.apply(Operator::subtract, column, {terms_.variable(left, column), integer_literal(1, column)}));
}

void Translator::exit_loop() {
  for (auto block = blocks_.rbegin(); block != blocks_.rend(); ++block)
    if (block->kind != Operation::if_begin) return builder_.jump(block->end);
  findings_.error(operation_column_, "EXIT_LOOP is outside a loop",
                  "use it between LOOP, WHILE, REPEAT or FOR and their ends");
}

}  // namespace cellmirror::program::irdata
