// The frame of a record: number, operation, section, comment.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "rt_core/base/text.hpp"
#include "scripts/programs/irdata/translator.hpp"

namespace cellmirror::program::irdata {

Translator::Translator(const ParseContext& context, const CodeTable& codes, Diagnostics& diagnostics)
    : codes_(codes),
      findings_(diagnostics, context.file),
      diagnostics_(diagnostics),
      builder_(context.file, "irdata", context.file),
      terms_(builder_, findings_),
      reader_(terms_, symbols_),
      jumps_(builder_, findings_) {
  reader_.in_header(true);
}

void Translator::expect_lines(std::size_t lines) {
  const std::size_t records = std::min(lines, kMostStatements);
  builder_.reserve(records);
  jumps_.reserve(records);
}

void Translator::read_line(std::string_view text) {
  findings_.at_line(++line_);
  if (text.size() > kLongestLine) {
    findings_.error(1, fmt::format("the line has {} bytes", text.size()),
                    fmt::format("divide it; {} bytes is the maximum", kLongestLine));
    return;
  }
  cursor_ = Cursor(text);
  cursor_.skip_blank();
  if (cursor_.at_end()) return;
  column_ = cursor_.column();
  operation_column_ = column_;
  numbered_ = false;
  if (cursor_.peek() == ';') {
    builder_.at(line_, column_);
    read_comment(text.substr(cursor_.at() + 1), column_ + 1);
    return;
  }
  if (++records_ > kMostStatements) {
    findings_.error(column_, fmt::format("there are more than {} records", kMostStatements),
                    "divide the program; the rest of the text was not read");
    cancelled_ = true;
    return;
  }
  read_number();
  if (!read_operation()) return;
  const bool allowed = section_allows();
  char label[16] = {'N'};
  const auto end = std::to_chars(label + 1, label + sizeof label, number_).ptr;
  builder_.at(line_, column_, numbered_ ? std::string_view(label, end) : std::string_view());
  if (!allowed) return;
  execute_record();
}

void Translator::execute_record() {
  if (operation_ == Operation::comment) {
    const bool text_follows = cursor_.take(',');
    cursor_.skip_blank();
    const std::uint32_t column = cursor_.column();
    if (!text_follows && !cursor_.at_end() && cursor_.peek() != ';')
      findings_.error(column, "a ',' is missing after COMMENT", "write COMMENT, text");
    else
      read_comment(cursor_.rest(), column);
    return;
  }
  const std::string_view whole = cursor_.line();
  const std::size_t comment = whole.find(';', cursor_.at());
  if (comment != std::string_view::npos) cursor_.end_at(comment);
  incomplete_ = false;
  parameter_begin_ = cursor_.at();
  switch (row_of(operation_).group) {
    case OperationGroup::header:
      header_record();
      break;
    case OperationGroup::declaration:
      declaration_record();
      break;
    case OperationGroup::motion:
      motion_record();
      break;
    case OperationGroup::setting:
      setting_record();
      break;
    case OperationGroup::flow:
      flow_record();
      break;
    case OperationGroup::arithmetic:
      arithmetic_record();
      break;
    case OperationGroup::signal:
      signal_record();
      break;
    case OperationGroup::comment:
      break;
  }
  finish_parameters();
  if (comment != std::string_view::npos)
    read_comment(whole.substr(comment + 1), static_cast<std::uint32_t>(comment) + 2);
}

// "40," or "N40,": the second is how people read it in messages.
void Translator::read_number() {
  if ((cursor_.peek() == 'N' || cursor_.peek() == 'n') && is_digit(cursor_.peek_behind())) cursor_.skip();
  const std::size_t begin = cursor_.at();
  std::uint64_t value = 0;
  for (; is_digit(cursor_.peek()); cursor_.skip())
    if (value <= kGreatestRecord) value = value * 10 + static_cast<std::uint64_t>(cursor_.peek() - '0');
  if (cursor_.at() == begin) {
    findings_.error(column_, "the record has no number", "begin it with a number and a comma; comments begin with ';'");
    return;
  }
  if (value > kGreatestRecord) {
    findings_.error(column_, "the number of the record is too large",
                    fmt::format("{} is the maximum", kGreatestRecord));
  } else if (any_number_ && value <= last_number_) {
    findings_.error(column_, fmt::format("record number {} does not follow {}", value, last_number_),
                    "record numbers must ascend");
  } else {
    numbered_ = true;
    any_number_ = true;
    number_ = last_number_ = static_cast<std::uint32_t>(value);
    jumps_.begin_record(number_, spot(column_));
  }
  if (!cursor_.take(','))
    findings_.error(cursor_.column(), "a ',' is missing after the number of the record",
                    "write number, operation, parameters");
}

std::string Translator::remedy_for(std::string_view name) {
  std::string near;
  if (findings_.may_suggest()) near = nearest_operation(name);
  return near.empty() ? "see docs/languages/irdata.md for the list of operations" : near;
}

bool Translator::read_operation() {
  cursor_.skip_blank();
  operation_column_ = cursor_.column();
  const std::size_t begin = cursor_.at();
  if (is_digit(cursor_.peek())) {
    std::uint64_t code = 0;
    while (is_digit(cursor_.peek())) {
      if (code <= kGreatestCode) code = code * 10 + static_cast<std::uint64_t>(cursor_.peek() - '0');
      cursor_.skip();
    }
    const auto operation = code <= kGreatestCode ? codes_.find(static_cast<std::uint32_t>(code)) : std::nullopt;
    if (operation) {
      operation_ = *operation;
      return true;
    }
    findings_.error(
        operation_column_,
        fmt::format("{} is not an operation code", printable(cursor_.line().substr(begin, cursor_.at() - begin), 20)),
        "see irdata_codes.tsv, or write the symbolic name");
    return false;
  }
  const std::string_view name = cursor_.name();
  const auto operation = find_operation(name);
  if (operation) {
    operation_ = *operation;
    return true;
  }
  if (name.empty())
    findings_.error(operation_column_, "the operation is missing",
                    "write its symbolic name or its code after the number");
  else
    findings_.error(operation_column_, fmt::format("'{}' is not an operation", printable(name, 40)), remedy_for(name));
  return false;
}

bool Translator::section_allows() {
  const OperationGroup group = row_of(operation_).group;
  const bool of_header = group == OperationGroup::header || group == OperationGroup::declaration;
  switch (section_) {
    case Section::before:
      if (operation_ == Operation::header || operation_ == Operation::comment) return true;
      findings_.error(column_, "the program does not begin with a header section",
                      "begin with 'HEADER, name' and close the section with END_HEADER");
      section_ = Section::header;
      if (!of_header) end_header();
      return true;
    case Section::header:
      if (of_header || operation_ == Operation::comment) return true;
      findings_.error(column_, fmt::format("{} is in the header section", row_of(operation_).name),
                      "close the section with a record END_HEADER before it");
      end_header();
      return true;
    case Section::main:
    case Section::subprogram:
      if (!of_header) return true;
      findings_.error(operation_column_, fmt::format("{} comes after the header section", row_of(operation_).name),
                      "put it before END_HEADER");
      return false;
    case Section::behind_end:
      break;
  }
  return leave_wrong_section();
}

// Behind END.
bool Translator::leave_wrong_section() {
  if (operation_ == Operation::subprogram || operation_ == Operation::comment) return true;
  if (!strayed_)
    findings_.error(operation_column_, fmt::format("{} comes after the end", row_of(operation_).name),
                    "only subprograms may follow END: open one with 'SUBPROGRAM, name', or move the record");
  strayed_ = true;
  return false;
}

// A comment that begins with % is a SCRIPT command.
void Translator::read_comment(std::string_view text, std::uint32_t column) {
  std::string_view content = trimmed(text);
  if (!content.starts_with('%')) return;
  column += static_cast<std::uint32_t>(content.data() - text.data());
  content = trimmed(content.substr(1));
  while (content.ends_with(';')) content = trimmed(content.substr(0, content.size() - 1));
  if (content.empty()) {
    findings_.error(column, "there is no SCRIPT command after '%'", "write one, or remove the '%' from the comment");
    return;
  }
  if (section_ != Section::main && section_ != Section::subprogram) {
    findings_.error(column, "a SCRIPT command is outside the executed sections",
                    "put it between END_HEADER and END, or into a subprogram; other comments do not begin with '%'");
    return;
  }
  add(ScriptStatement{builder_.text(content)}, column);
}

Spot Translator::spot(std::uint32_t column) const { return {line_, column, block_, scope_}; }

std::shared_ptr<const Program> Translator::finish(std::shared_ptr<const Program>* read_part) {
  findings_.at_line(std::max<std::uint32_t>(line_, 1));
  if (!cancelled_) {
    switch (section_) {
      case Section::before:
        findings_.error(1, "the text has no program",
                        "begin with 'HEADER, name' and close the section with END_HEADER");
        break;
      case Section::header:
        findings_.error(1, "the header section is not closed", "close it with a record END_HEADER");
        break;
      case Section::main:
        end_section();
        findings_.error(1, "the program is not closed", "close it with a record END");
        break;
      case Section::subprogram:
        end_section();
        findings_.error_at(subprogram_spot_.line, subprogram_spot_.column, "the subprogram is not closed",
                           "close it with a record END_SUBPROGRAM");
        break;
      case Section::behind_end:
        break;
    }
  }
  jumps_.finish();
  return builder_.build(diagnostics_, read_part);
}

}  // namespace cellmirror::program::irdata
