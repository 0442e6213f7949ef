// The header section: name of the program, declarations, data.
#include <fmt/format.h>

#include <algorithm>

#include "rt_core/base/text.hpp"
#include "scripts/programs/irdata/translator.hpp"

namespace cellmirror::program::irdata {

void Translator::header_record() {
  if (operation_ == Operation::end_header) {
    end_header();
    return;
  }
  if (operation_ != Operation::header) {  // for people only
    static_cast<void>(free_text());
    return;
  }
  if (section_ == Section::header) {
    findings_.error(operation_column_, "there is a second HEADER", "one program has one header section");
    static_cast<void>(free_text());
    return;
  }
  section_ = Section::header;
  const std::string_view name = name_parameter("the name of the program");
  if (!name.empty()) builder_.rename(std::string(name));
}

void Translator::declaration_record() {
  switch (operation_) {
    case Operation::boolean:
      return declare_variable(ValueType::boolean);
    case Operation::integer:
      return declare_variable(ValueType::integer);
    case Operation::real:
      return declare_variable(ValueType::real);
    case Operation::pose:
      return declare_variable(ValueType::pose);
    case Operation::joints:
      return declare_variable(ValueType::joints);
    case Operation::constant:
      return declare_constant();
    case Operation::list:
      return declare_list();
    case Operation::data:
      return read_data();
    default:
      return declare_semaphore();
  }
}

// A name that may be declared; empty after a fault.
std::string_view Translator::new_name(std::string_view what) {
  const std::string_view name = name_parameter(what);
  if (name.empty()) return {};
  const auto column = static_cast<std::uint32_t>(name.data() - cursor_.line().data()) + 1;
  if (find_word(name)) {
    findings_.error(column, fmt::format("'{}' is a reserved word", name), "choose another name");
    return {};
  }
  if (const Symbol* symbol = symbols_.find(name); symbol != nullptr && symbol->kind != Symbol::Kind::unknown) {
    findings_.error(column, fmt::format("'{}' is declared already, in line {}", name, symbol->line),
                    "choose another name");
    return {};
  }
  return name;
}

void Translator::declare_variable(ValueType type) {
  const std::string_view name = new_name("the name of the variable");
  std::optional<Value> initial;
  cursor_.skip_blank();
  if (!cursor_.at_end()) {
    const Term value = checked(constant_parameter("the first value"), "the first value", type);
    if (value.known) initial = terms_.constant(value);
  }
  if (name.empty()) return;
  const auto variable = builder_.declare(name, type, initial);
  if (!variable) {
    refuse(operation_column_, variable.error());
    return;
  }
  symbols_.add(name, {Symbol::Kind::variable, type, line_, *variable, 0});
}

void Translator::declare_constant() {
  const std::string_view name = new_name("the name of the constant");
  const Term term = constant_parameter("the value of a CONSTANT");
  const auto value = terms_.constant(term);
  if (name.empty()) return;
  if (!value) {
    symbols_.add(name, Symbol{});  // reported; what uses it is not wrong because of that
    return;
  }
  symbols_.add(name,
               {Symbol::Kind::constant, term.type, line_, 0, static_cast<std::uint32_t>(symbols_.constants.size())});
  symbols_.constants.push_back(*value);
}

void Translator::declare_list() {
  const std::string_view name = new_name("the name of the list");
  if (!require_parameter()) return;
  List list;
  list.name = name;
  list.line = line_;
  list.column = operation_column_;
  const std::uint32_t column = cursor_.column();
  const std::string_view text = cursor_.name();
  const std::optional<Word> word = find_word(text);
  if (word == Word::boolean) {
    list.type = ValueType::boolean;
  } else if (word == Word::integer) {
    list.type = ValueType::integer;
  } else if (word == Word::pose) {
    list.type = ValueType::pose;
  } else if (word == Word::joints) {
    list.type = ValueType::joints;
  } else if (word != Word::real) {
    findings_.error(column, fmt::format("'{}' is not a type", printable(text, 30)),
                    "write BOOLEAN, INTEGER, REAL, POSE or JOINTS");
    list.good = false;
    cursor_.skip_parameter(parameter_begin_);
  }
  end_parameter();
  cursor_.skip_blank();
  if (!cursor_.at_end()) read_list_bounds(list);
  if (name.empty()) return;
  symbols_.add(name, {Symbol::Kind::list, list.type, line_, 0, static_cast<std::uint32_t>(lists_.size())});
  lists_.push_back(std::move(list));
}

void Translator::read_list_bounds(List& list) {
  const Term first = checked(constant_parameter("the first index"), "the first index", ValueType::integer);
  const Term last = checked(constant_parameter("the last index"), "the last index", ValueType::integer);
  const auto from = terms_.constant_number(first);
  const auto to = terms_.constant_number(last);
  list.good = list.good && from && to;
  if (!from || !to) return;
  const auto greatest = static_cast<double>(kGreatestIndex);
  if (*from < -greatest || *to > greatest || *to < *from || *to - *from >= static_cast<double>(kMostListElements)) {
    findings_.error(first.column, fmt::format("indices cannot go from {} to {}", *from, *to),
                    fmt::format("the last must not be below the first; at most {} elements", kMostListElements));
    list.good = false;
    return;
  }
  list.first = static_cast<std::int64_t>(*from);
  list.last = static_cast<std::int64_t>(*to);
}

void Translator::read_data() {
  if (!require_parameter()) return;
  const std::uint32_t column = cursor_.column();
  const std::string_view name = cursor_.name();
  end_parameter();
  const Symbol* symbol = symbols_.find(name);
  if (symbol == nullptr || symbol->kind != Symbol::Kind::list) {
    if (symbol == nullptr || symbol->kind != Symbol::Kind::unknown)
      findings_.error(column, fmt::format("'{}' is not a list", printable(name, 40)),
                      "declare it before with 'LIST, name, type'");
    symbols_.add(name, Symbol{});
    cursor_.go_to(cursor_.line().size());
    return;
  }
  List& list = lists_[symbol->detail];
  if (!list.good) {
    cursor_.go_to(cursor_.line().size());
    return;
  }
  const std::size_t room = list.last ? static_cast<std::size_t>(*list.last - list.first + 1) : kMostListElements;
  bool full = false;
  do {
    const Term value = checked(constant_parameter("an element"), "an element of this list", list.type);
    if (incomplete_) return;
    const auto constant = terms_.constant(value);
    full = list.values.size() >= room || list_elements_ >= kMostListElements;
    if (full) {
      findings_.error(value.known ? value.column : column,
                      fmt::format("list '{}' has more than {} elements", name, list.values.size()),
                      list.values.size() >= room ? "remove them, or declare it with a larger last index"
                                                 : "that is the limit of all lists together");
      cursor_.go_to(cursor_.line().size());
      return;
    }
    ++list_elements_;
    list.values.push_back(constant.value_or(default_value(list.type)));
    cursor_.skip_blank();
  } while (!cursor_.at_end());
}

void Translator::declare_semaphore() {
  const std::string_view name = name_parameter("the name of the semaphore");
  double count = 0;
  cursor_.skip_blank();
  if (!cursor_.at_end()) {
    const Term term = checked(constant_parameter("the first count"), "the first count", ValueType::integer);
    const auto value = terms_.constant_number(term);
    constexpr double kGreatestCount = 1e6;
    if (value && (*value < 0 || *value > kGreatestCount))
      findings_.error(term.column, fmt::format("a semaphore cannot begin with {}", *value),
                      fmt::format("write 0 to {}", kGreatestCount));
    else
      count = value.value_or(0);
  }
  if (name.empty()) return;
  const auto [known, is_new] = semaphores_.try_emplace(name, line_);
  if (!is_new) {
    findings_.error(operation_column_,
                    fmt::format("semaphore '{}' is declared already, in line {}", name, known->second),
                    "declare it once");
    return;
  }
  const auto declared = builder_.declare_semaphore(name, static_cast<std::uint32_t>(count), line_);
  if (!declared) refuse(operation_column_, declared.error());
}

void Translator::end_header() {
  section_ = Section::main;
  reader_.in_header(false);
  for (List& list : lists_) {
    const std::size_t count = list.last ? static_cast<std::size_t>(*list.last - list.first + 1) : list.values.size();
    Symbol unknown;
    Symbol* symbol = symbols_.add(list.name, unknown).first;
    if (count == 0 || !list.good) {
      if (list.good)
        findings_.error_at(list.line, list.column, fmt::format("list '{}' has no elements", list.name),
                           "add DATA, or a first and a last index");
      *symbol = unknown;
      continue;
    }
    const auto variable = builder_.declare_list(list.name, list.type, list.first, count, std::move(list.values));
    if (variable) {
      symbol->variable = *variable;
    } else {
      findings_.error_at(list.line, list.column, variable.error().what, variable.error().remedy);
      *symbol = unknown;
    }
  }
  lists_.clear();
}

}  // namespace cellmirror::program::irdata
