// What a program has declared, and what is found under a name.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "scripts/programs/program/program.hpp"

namespace cellmirror::program::rapid {

// Data types. num is a real; robtarget is a pose; jointtarget is joints.
enum class Type : std::uint8_t { unknown, num, boolean, robtarget, jointtarget, speeddata, signal_in, signal_out };
// As the language spells it.
[[nodiscard]] std::string_view word_of(Type type);
// Of what the machine computes with.
[[nodiscard]] ValueType value_type(Type type);

struct Speed {
  double path_mm_s = 0;  // none of the two: the robot's own velocities (vmax)
  double turn_deg_s = 0;
  [[nodiscard]] bool own() const { return path_mm_s == 0; }
};

struct Declared {
  enum class Storage : std::uint8_t {
    unusable,  // declared, but not as the subset has it: reported where it is declared
    variable,
    constant,
    counter,  // of FOR: may be read only
  };
  Storage storage = Storage::unusable;
  Type type = Type::unknown;
  VariableId variable = kNone;
  Value value;  // of constants
  Speed speed;  // of speeddata
  std::uint32_t line = 0;
};

// Names without regard to case: counters of loops hide data of the procedure, these hide data of the modules.
class Names {
 public:
  [[nodiscard]] const Declared* find(std::string_view name) const;
  // False where this scope has the name already.
  bool add(std::string_view name, const Declared& declared);
  // Once reported, an unknown name is not reported again in this procedure.
  void forgive(std::string_view name);
  // Null if it is new in the present scope.
  [[nodiscard]] const Declared* find_in_scope(std::string_view name) const;
  void begin_procedure() { in_procedure_ = true; }
  void end_procedure();
  void push_counter(std::string_view name, const Declared& counter);
  void pop_counter() { counters_.pop_back(); }
  // All of them; for proposals.
  [[nodiscard]] std::vector<std::string> all() const;
  [[nodiscard]] std::size_t size() const { return data_.size() + local_.size() + counters_.size(); }

 private:
  struct Counter {
    std::string name;
    Declared declared;
  };
  std::unordered_map<std::string, Declared> data_;   // keys in lower case
  std::unordered_map<std::string, Declared> local_;  // of the procedure
  std::vector<Counter> counters_;                    // the innermost last
  bool in_procedure_ = false;
};

}  // namespace cellmirror::program::rapid
