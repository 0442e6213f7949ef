#include "scripts/programs/irdata/code_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "rt_core/base/text.hpp"

namespace cellmirror::program::irdata {

namespace {

constexpr std::size_t kMostRows = 100'000;

struct CodeLine {
  std::string_view code;
  std::string_view name;
  int name_column = 0;
};

CodeLine cut_code_line(std::string_view line) {
  CodeLine cut;
  const std::size_t tab = std::min(line.find('\t'), line.size());
  cut.code = trimmed(line.substr(0, tab));
  if (tab == line.size()) return cut;
  const std::size_t next = std::min(line.find('\t', tab + 1), line.size());
  cut.name = trimmed(line.substr(tab + 1, next - tab - 1));
  cut.name_column = static_cast<int>(tab) + 2;
  return cut;
}

std::optional<CodeTable::Row> read_code_line(std::string_view line, const Place& place, Diagnostics& diagnostics) {
  const CodeLine cut = cut_code_line(line);
  const std::optional<long long> code = parse_integer(cut.code);
  if (!code || *code < 0 || *code > kGreatestCode) {
    diagnostics.error(place, fmt::format("'{}' is not an operation code", printable(cut.code)),
                      fmt::format("write a number from 0 to {}, a tab and the operation's name", kGreatestCode));
    return std::nullopt;
  }
  const std::optional<Operation> operation = find_operation(cut.name);
  if (!operation) {
    Place there = place;
    there.column = std::max(cut.name_column, 1);
    diagnostics.error(there, fmt::format("'{}' is not an operation", printable(cut.name)),
                      cut.name.empty() ? "write its symbolic name after a tab" : nearest_operation(cut.name));
    return std::nullopt;
  }
  return CodeTable::Row{static_cast<std::uint32_t>(*code), *operation, static_cast<std::uint32_t>(place.line)};
}

}  // namespace

CodeTable CodeTable::read(std::string_view text, const std::string& file, Diagnostics& diagnostics) {
  CodeTable table;
  int number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    ++number;
    if (trimmed(line).empty() || line.starts_with('#')) continue;
    if (table.rows_.size() == kMostRows) {
      diagnostics.error({file, number, 0}, fmt::format("there are more than {} operation codes", kMostRows));
      break;
    }
    if (const std::optional<Row> row = read_code_line(line, {file, number, 1}, diagnostics))
      table.rows_.push_back(*row);
  }
  std::ranges::sort(table.rows_, {}, [](const Row& row) { return std::pair(row.code, row.line); });
  for (std::size_t i = 1; i < table.rows_.size(); ++i) {
    const Row& before = table.rows_[i - 1];
    const Row& row = table.rows_[i];
    if (row.code == before.code)
      diagnostics.error({file, static_cast<int>(row.line), 1},
                        fmt::format("operation code {} is in line {} already", row.code, before.line),
                        "give each operation a code of its own");
  }
  return table;
}

std::optional<Operation> CodeTable::find(std::uint32_t code) const {
  const auto row = std::ranges::lower_bound(rows_, code, {}, &Row::code);
  if (row == rows_.end() || row->code != code) return std::nullopt;
  return row->operation;
}

}  // namespace cellmirror::program::irdata
