// Names that a program declares: variables, lists, constants. Case counts, as in names of SCRIPT.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "scripts/programs/program/program.hpp"

namespace cellmirror::program::irdata {

struct Symbol {
  enum class Kind : std::uint8_t { variable, list, constant, unknown };  // unknown: used, never declared, reported once
  Kind kind = Kind::unknown;
  ValueType type = ValueType::real;
  std::uint32_t line = 0;    // of the declaration
  VariableId variable = 0;   // of the program; a list has one when its data are complete
  std::uint32_t detail = 0;  // list: index of its data; constant: index of its value
};

class Symbols {
 public:
  [[nodiscard]] const Symbol* find(std::string_view name) const {
    const auto entry = symbols_.find(name);
    return entry == symbols_.end() ? nullptr : &entry->second;
  }
  // The one that is there already, or the new one; `name` must outlive the table.
  std::pair<Symbol*, bool> add(std::string_view name, const Symbol& symbol) {
    const auto [entry, is_new] = symbols_.try_emplace(name, symbol);
    return {&entry->second, is_new};
  }
  // Names for suggestions, at most `most`, sorted.
  [[nodiscard]] std::vector<std::string> names(std::size_t most) const {
    std::vector<std::string> out;
    for (const auto& [name, symbol] : symbols_) {
      if (symbol.kind == Symbol::Kind::unknown) continue;
      if (out.size() == most) break;
      out.emplace_back(name);
    }
    std::ranges::sort(out);
    return out;
  }
  std::vector<Value> constants;  // of CONSTANT

 private:
  std::unordered_map<std::string_view, Symbol> symbols_;
};

}  // namespace cellmirror::program::irdata
