// The bytes of a .msh file: words and numbers of ASCII sections, values of binary ones. After the first error every
// read gives nothing. Private to this folder.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include "rt_core/base/diagnostics.hpp"

namespace cellmirror::msh {

class Input {
 public:
  Input(std::string_view bytes, const std::string& file, Diagnostics& diagnostics)
      : bytes_(bytes), file_(file), diagnostics_(diagnostics) {}

  [[nodiscard]] bool failed() const { return failed_; }
  // The first one counts. `at`: byte from 0, as offset() gives it.
  void refuse(std::size_t at, std::string what, std::string remedy = {});
  // An error that does not end reading, e.g. of one of many tetrahedra.
  void error(std::size_t at, std::string what, std::string remedy = {});

  // --- text ---
  // The next word, between blanks and line ends; empty at the end of the file.
  std::string_view word();
  // The rest of the line, without blanks at its ends.
  std::string_view line();
  double number(const char* what);
  std::int64_t integer(const char* what);

  // --- binary ---
  template <class Value>
  Value value(const char* what) {
    static_assert(std::is_arithmetic_v<Value>);
    Value out{};
    if (failed_) return out;
    if (left() < sizeof(Value)) {
      refuse(offset_, ended(what));
      return out;
    }
    char raw[sizeof(Value)];
    for (std::size_t i = 0; i < sizeof(Value); ++i) raw[swapped_ ? sizeof(Value) - 1 - i : i] = bytes_[offset_ + i];
    std::memcpy(&out, raw, sizeof(Value));
    offset_ += sizeof(Value);
    return out;
  }
  void skip(std::size_t count, const char* what);
  void set_binary(bool binary) { binary_ = binary; }
  void set_swapped(bool swapped) { swapped_ = swapped; }
  [[nodiscard]] bool binary() const { return binary_; }

  // An integer of the file's kind: a word, or a binary Value.
  template <class Value>
  std::int64_t integer_as(const char* what) {
    return binary_ ? static_cast<std::int64_t>(value<Value>(what)) : integer(what);
  }
  double number_as(const char* what) { return binary_ ? value<double>(what) : number(what); }

  // A count that fits what is left of the file, where each item takes at least `least_bytes`, and `most`; else 0 and an
  // error.
  std::size_t checked_count(std::int64_t count, std::size_t at, std::size_t least_bytes, std::size_t most,
                            const char* what);

  // --- sections ---
  // Goes behind the line `text` that follows next; false where there is none.
  bool skip_behind(std::string_view text);
  void expect(std::string_view text);
  [[nodiscard]] std::size_t offset() const { return offset_; }
  // Where the next word begins.
  std::size_t next();
  [[nodiscard]] std::size_t left() const { return bytes_.size() - offset_; }
  [[nodiscard]] Place place(std::size_t at) const;

 private:
  [[nodiscard]] std::string ended(const char* what) const;
  [[nodiscard]] std::string with_byte(std::size_t at, std::string what) const;

  std::string_view bytes_;
  const std::string& file_;
  Diagnostics& diagnostics_;
  std::size_t offset_ = 0;
  bool binary_ = false;
  bool swapped_ = false;
  bool failed_ = false;
};

}  // namespace cellmirror::msh
