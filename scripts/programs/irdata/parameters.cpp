// Parameters of a record, one behind the other.
#include <fmt/format.h>

#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "rt_core/base/text.hpp"
#include "scripts/programs/irdata/translator.hpp"

namespace cellmirror::program::irdata {

// Between parameters the cursor is at a comma or at the end of the record.
bool Translator::next_parameter() {
  cursor_.skip_blank();
  if (cursor_.at_end()) return false;
  if (!cursor_.take(',')) {  // behind the operation only
    findings_.error(cursor_.column(), fmt::format("a ',' is missing after {}", row_of(operation_).name),
                    "write " + form_of(operation_));
    cursor_.skip_parameter(cursor_.at());
    if (!cursor_.take(',')) return false;
  }
  cursor_.skip_blank();
  parameter_begin_ = cursor_.at();
  return true;
}

bool Translator::require_parameter() {
  if (next_parameter()) return true;
  if (!incomplete_)
    findings_.error(cursor_.column(), fmt::format("{} has too few parameters", row_of(operation_).name),
                    "write " + form_of(operation_));
  incomplete_ = true;
  return false;
}

void Translator::end_parameter() {
  cursor_.skip_blank();
  if (cursor_.at_end() || cursor_.peek() == ',') return;
  findings_.error(cursor_.column(),
                  fmt::format("'{}' cannot follow in this parameter", printable(cursor_.rest().substr(0, 1))),
                  "put a comma between parameters, or an operator between values");
  cursor_.skip_parameter(parameter_begin_);
}

void Translator::finish_parameters() {
  if (incomplete_ || !next_parameter()) return;
  const OperationRow& row = row_of(operation_);
  const auto column = static_cast<std::uint32_t>(parameter_begin_) + 1;
  const std::string_view name = cursor_.name();
  const std::array<std::string, 1> fly = {"FLY"};
  if (row.parameters.ends_with("[, FLY]") && !name.empty()) {
    if (std::string meant = did_you_mean(name, fly); !meant.empty())
      return findings_.error(column, fmt::format("'{}' is not FLY", printable(name, 20)), std::move(meant));
  }
  findings_.error(column, fmt::format("{} has too many parameters", row.name),
                  row.parameters.empty() ? fmt::format("write {} alone", row.name) : "write " + form_of(operation_));
}

Term Translator::value_parameter() {
  if (!require_parameter()) return {};
  const Term term = reader_.read(cursor_);
  if (reader_.syntax_failed()) {
    cursor_.skip_parameter(parameter_begin_);
    return {};
  }
  end_parameter();
  return term;
}

// Integers are reals where reals are wanted.
Term Translator::checked(const Term& term, std::string_view what, ValueType type) {
  if (!term.known || term.type == type) return term;
  if (type == ValueType::real && term.type == ValueType::integer) return terms_.as_real(term);
  findings_.error(term.column, fmt::format("{} is {}, this is {}", what, with_article(type), with_article(term.type)),
                  type == ValueType::integer && term.type == ValueType::real ? "use ROUND or TRUNC"
                                                                             : "write " + form_of(operation_));
  return {};
}

Term Translator::typed_parameter(std::string_view what, ValueType type) {
  return checked(value_parameter(), what, type);
}

Term Translator::constant_parameter(std::string_view what) {
  const Term term = value_parameter();
  if (!term.known || terms_.constant(term)) return term;
  findings_.error(term.column, fmt::format("{} is not constant", what),
                  "write a number, a CONSTANT, or a pose or joint values of those");
  return {};
}

Term Translator::port_parameter() {
  Term term = typed_parameter("the number of an input or output", ValueType::integer);
  const auto value = terms_.constant_number(term);
  if (!value || (*value >= 1 && *value <= static_cast<double>(kMostPorts))) return term;
  findings_.error(term.column, fmt::format("there is no input or output {}", *value),
                  fmt::format("numbers go from 1 to {}", kMostPorts));
  return {};
}

AssignTarget Translator::target_parameter() {
  if (!require_parameter()) return {};
  const AssignTarget target = reader_.read_target(cursor_);
  if (reader_.syntax_failed()) {
    cursor_.skip_parameter(parameter_begin_);
    return {};
  }
  end_parameter();
  return target;
}

bool Translator::word_parameter(Word word) {
  const std::size_t before = cursor_.at();
  cursor_.skip_blank();
  if (cursor_.take(',')) {
    cursor_.skip_blank();
    parameter_begin_ = cursor_.at();
    if (find_word(cursor_.name()) == word) {
      end_parameter();
      return true;
    }
  }
  cursor_.go_to(before);
  return false;
}

std::string_view Translator::name_parameter(std::string_view what) {
  if (!require_parameter()) return {};
  const std::uint32_t column = cursor_.column();
  const std::string_view name = cursor_.name();
  if (name.empty()) {
    findings_.error(column, fmt::format("{} is missing", what),
                    "names have letters, digits and '_' and begin with a letter");
    cursor_.skip_parameter(parameter_begin_);
    return {};
  }
  if (name.size() > kMaxNameLength) {
    findings_.error(column, fmt::format("the name has {} letters", name.size()),
                    fmt::format("{} is the maximum", kMaxNameLength));
    end_parameter();
    return {};
  }
  end_parameter();
  return name;
}

// The rest of the record, whatever is in it.
std::string_view Translator::free_text() {
  if (!require_parameter()) return {};
  const std::string_view text = trimmed(cursor_.rest());
  cursor_.go_to(cursor_.line().size());
  return text;
}

std::optional<ProgramBuilder::Label> Translator::jump_parameter() {
  if (!require_parameter()) return std::nullopt;
  const std::uint32_t column = cursor_.column();
  if (!is_digit(cursor_.peek())) {
    const std::string_view name = cursor_.name();
    if (!name.empty()) {
      end_parameter();
      return jumps_.to_label(name, spot(column));
    }
    findings_.error(column, "the label is missing", "write the name of a LABEL or the number of a record");
    cursor_.skip_parameter(parameter_begin_);
    return std::nullopt;
  }
  bool whole = true;
  const std::string_view text = cursor_.number(whole);
  const auto number = parse_integer(text);
  if (!whole || !number || *number > kGreatestRecord) {
    findings_.error(column, fmt::format("'{}' is not the number of a record", printable(text, 20)),
                    "write the number at the beginning of the record");
    cursor_.skip_parameter(parameter_begin_);
    return std::nullopt;
  }
  end_parameter();
  return jumps_.to_record(static_cast<std::uint32_t>(*number), spot(column));
}

void Translator::add(const Statement& statement, std::uint32_t column) {
  if (const auto added = builder_.add(statement); !added) refuse(column, added.error());
}

void Translator::refuse(std::uint32_t column, const Error& error) { findings_.error(column, error.what, error.remedy); }

}  // namespace cellmirror::program::irdata
