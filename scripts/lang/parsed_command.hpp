// A command after parsing and checking: its form and its values in SI. Allocates nothing; meant to be reused from
// command to command. The views in it point into the text it was read from.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "rt_core/base/contract.hpp"
#include "scripts/lang/form.hpp"

namespace cellmirror::script {

// A place in a text: the byte, and line and column (from 1, in bytes).
struct Position {
  std::size_t offset = 0;
  int line = 1;
  int column = 1;
};

struct Value {
  std::string_view text;  // the word as it was written
  double number;          // SI; an integer exactly; of a choice its index
};

// MASTER_SLAVE has the longest list: on, master, count, and for each of 5 slaves its name, count and 16 pairs of names.
inline constexpr std::size_t kMaxSlaves = 5;
inline constexpr std::size_t kMaxValues = 3 + kMaxSlaves * (2 + 2 * kMaxJointsPerRobot);

// A named place of a value; slots.hpp has those of the forms.
// Converts to the number of the slot, for ParsedCommand::text(), number(), ...
struct Slot {
  std::size_t first;      // of `width` slots
  std::size_t parameter;  // index in the form's list, for ParsedCommand::given()
  std::string_view name;  // the parameter's label; where it has none, its name

  constexpr operator std::size_t() const { return first; }  // NOLINT: it stands for its number
};

class ParsedCommand {
 public:
  [[nodiscard]] const Form& form() const {
    CELLMIRROR_EXPECTS(form_ != nullptr);
    return *form_;
  }
  [[nodiscard]] FormId id() const { return form().id; }
  [[nodiscard]] const Position& begin() const { return begin_; }

  // Slots: the values one after another. Every parameter takes `width` slots, a fixed word none; a labelled group that
  // was not given leaves its slots at 0; a list, always last, takes as many as it has.
  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] std::string_view text(std::size_t slot) const { return at(slot).text; }
  [[nodiscard]] double number(std::size_t slot) const { return at(slot).number; }
  [[nodiscard]] std::int64_t integer(std::size_t slot) const { return static_cast<std::int64_t>(at(slot).number); }
  [[nodiscard]] std::size_t choice(std::size_t slot) const { return static_cast<std::size_t>(at(slot).number); }
  // Copies the numbers of the slots from `first` on; returns how many.
  std::size_t numbers(std::size_t first, std::span<double> out) const {
    std::size_t n = 0;
    for (std::size_t slot = first; slot < count_ && n < out.size(); ++slot) out[n++] = values_[slot].number;
    return n;
  }
  // Whether the parameter at this index of the form's list was given (optional and labelled ones).
  [[nodiscard]] bool given(std::size_t parameter) const { return ((given_ >> parameter) & 1U) != 0; }
  [[nodiscard]] bool given(const Slot& slot) const { return given(slot.parameter); }
  // False if joint values are still in the text's unit because no directory gave the kinds of the joints. Such a
  // command can be checked, but not executed.
  [[nodiscard]] bool converted() const { return converted_; }

  // For the parser.
  void start(const Form& form, Position begin) {
    form_ = &form;
    begin_ = begin;
    count_ = 0;
    given_ = 0;
    converted_ = true;
  }
  void push(std::string_view text, double number) {
    CELLMIRROR_EXPECTS(count_ < kMaxValues);
    values_[count_++] = Value{text, number};
  }
  [[nodiscard]] Value& slot(std::size_t index) {
    CELLMIRROR_EXPECTS(index < count_);
    return values_[index];
  }
  void set_given(std::size_t parameter) { given_ |= 1U << parameter; }
  void set_unconverted() { converted_ = false; }

 private:
  [[nodiscard]] const Value& at(std::size_t slot) const {
    CELLMIRROR_EXPECTS(slot < count_);
    return values_[slot];
  }

  const Form* form_ = nullptr;
  Position begin_;
  std::size_t count_ = 0;
  std::uint32_t given_ = 0;
  bool converted_ = true;
  std::array<Value, kMaxValues> values_;
};

}  // namespace cellmirror::script
