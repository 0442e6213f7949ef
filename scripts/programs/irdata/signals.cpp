// Inputs and outputs, waiting, semaphores.
#include <fmt/format.h>

#include <algorithm>

#include "rt_core/base/text.hpp"
#include "scripts/programs/irdata/translator.hpp"

namespace cellmirror::program::irdata {

void Translator::signal_record() {
  switch (operation_) {
    case Operation::din:
    case Operation::ain: {
      const AssignTarget target = target_parameter();
      const Term number = port_parameter();
      return assign(target,
                    terms_.apply(operation_ == Operation::din ? Operator::digital_input : Operator::analogue_input,
                                 operation_column_, {number}));
    }
    case Operation::dout:
    case Operation::aout:
      return output_record();
    case Operation::pulse:
      return pulse_record();
    case Operation::wait_time: {
      const Term seconds = duration_parameter();
      if (seconds.known) add(DelayStatement{terms_.id(seconds)}, operation_column_);
      return;
    }
    case Operation::wait_input:
    case Operation::wait_until:
      return wait_record();
    default:
      return semaphore_record();
  }
}

Term Translator::duration_parameter() {
  const Term term = typed_parameter("a time in seconds", ValueType::real);
  const auto value = terms_.constant_number(term);
  if (!value || (*value >= 0 && *value <= kLongestTime_s)) return term;
  findings_.error(term.column, fmt::format("a time cannot be {} s", *value),
                  fmt::format("write 0 to {} seconds", kLongestTime_s));
  return {};
}

void Translator::output_record() {
  OutputStatement output;
  output.analogue = operation_ == Operation::aout;
  const Term number = port_parameter();
  const Term value = output.analogue ? typed_parameter("the value of an output", ValueType::real)
                                     : typed_parameter("the state of an output", ValueType::boolean);
  if (!number.known || !value.known) return;
  output.number = terms_.id(number);
  output.value = terms_.id(value);
  add(output, operation_column_);
}

// On, wait, off.
void Translator::pulse_record() {
  const Term number = port_parameter();
  const std::size_t begin = parameter_begin_;
  const Term seconds = duration_parameter();
  if (!number.known || !seconds.known) return;
  Cursor again(cursor_.line());
  again.go_to(begin);
  const Term once_more = reader_.read(again);
  if (!once_more.known) return;
  const auto output = [&](const Term& port, bool on) {
    OutputStatement statement;
    statement.number = terms_.id(port);
    statement.value = terms_.id(terms_.value(on, port.column));
    add(statement, operation_column_);
  };
  output(number, true);
  add(DelayStatement{terms_.id(seconds)}, operation_column_);
  output(once_more, false);
}

// "3, ON": the awaited state, and its text in messages.
Term Translator::input_condition(std::string& text) {
  const Term number = port_parameter();
  const std::size_t begin = parameter_begin_;
  const std::string_view written = trimmed(cursor_.line().substr(begin, cursor_.at() - begin));
  const Term state = typed_parameter("the state of an input", ValueType::boolean);
  if (!number.known || !state.known) return {};
  const Term input = terms_.apply(Operator::digital_input, number.column, {number});
  const auto constant = terms_.constant(state);
  if (!constant) {
    text = fmt::format("input {} is as wanted", written);
    return terms_.apply(Operator::equal, number.column, {input, state});
  }
  const bool on = std::get<bool>(*constant);
  text = fmt::format("input {} is {}", written, on ? "on" : "off");
  return on ? input : terms_.apply(Operator::logical_not, number.column, {input});
}

void Translator::wait_record() {
  std::string text;
  if (operation_ == Operation::wait_input) {
    const Term condition = input_condition(text);
    return finish_wait(condition, text);
  }
  const Term condition = typed_parameter("a condition", ValueType::boolean);
  text = trimmed(cursor_.line().substr(parameter_begin_, cursor_.at() - parameter_begin_));
  finish_wait(condition, text);
}

// Timeout and label: where the program continues after a timeout. Without a label a timeout is an error of the program.
void Translator::finish_wait(const Term& condition, const std::string& text) {
  WaitStatement wait;
  bool good = condition.known;
  const std::uint32_t column = operation_column_;
  cursor_.skip_blank();
  std::optional<ProgramBuilder::Label> label;
  if (!cursor_.at_end() && !incomplete_) {
    const Term seconds = duration_parameter();
    good = good && seconds.known;
    if (seconds.known) wait.timeout_s = terms_.id(seconds);
    cursor_.skip_blank();
    if (!cursor_.at_end()) label = jump_parameter();
  }
  if (!good) return;
  if (label) {
    if (timed_out_ == kNone) timed_out_ = hidden_variable(ValueType::boolean);
    wait.timed_out = timed_out_;
  }
  wait.condition = terms_.id(condition);
  wait.text = builder_.text(text);
  add(wait, column);
  if (label && timed_out_ != kNone)
    branch(terms_.apply(Operator::logical_not, column, {terms_.variable(timed_out_, column)}), *label);
}

void Translator::semaphore_record() {
  const std::string_view name = name_parameter("the name of the semaphore");
  if (name.empty()) return;
  const auto column = static_cast<std::uint32_t>(name.data() - cursor_.line().data()) + 1;
  if (!semaphores_.contains(name)) {
    std::string remedy = "declare it in the header section with 'SEMAPHORE, name, first count'";
    if (findings_.may_suggest()) {
      std::vector<std::string> names;
      for (const auto& [known, line] : semaphores_)
        if (names.size() < kMostSemaphores) names.emplace_back(known);
      std::ranges::sort(names);
      const std::string near = did_you_mean(name, names);
      if (!near.empty()) remedy = near + " Or " + remedy;
    }
    findings_.error(column, fmt::format("semaphore '{}' is not declared", name), remedy);
    semaphores_.try_emplace(name, line_);
    return;
  }
  add(SemaphoreStatement{operation_ == Operation::acquire, builder_.text(name)}, operation_column_);
}

}  // namespace cellmirror::program::irdata
