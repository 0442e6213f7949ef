// What a program has declared.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "scripts/programs/program/program.hpp"
#include "scripts/programs/srcl/operand.hpp"

namespace cellmirror::program::srcl {

struct Declared {
  enum class Kind : std::uint8_t { variable, list, constant, semaphore };
  Kind kind = Kind::variable;
  ValueType type = ValueType::real;
  VariableId variable = kNone;  // of variables and lists
  std::uint32_t line = 0;
  std::int64_t first = 1;  // of lists: the indices
  std::int64_t last = 0;
  Operand value;  // of constants
};

// Names are views into the program's text.
class Names {
 public:
  [[nodiscard]] const Declared* find(std::string_view name) const {
    const auto at = declared_.find(name);
    return at == declared_.end() ? nullptr : &at->second;
  }
  void add(std::string_view name, const Declared& declared) { declared_.emplace(name, declared); }
  [[nodiscard]] std::size_t size() const { return declared_.size(); }
  // In alphabetical order; for proposals.
  [[nodiscard]] std::vector<std::string> all() const;

 private:
  std::unordered_map<std::string_view, Declared> declared_;
};

}  // namespace cellmirror::program::srcl
