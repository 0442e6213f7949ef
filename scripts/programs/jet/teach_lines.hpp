// Splits the text of a teach file into lines and words. Handles comments, but no statements.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "scripts/programs/jet/teach_file.hpp"

namespace cellmirror::program {

struct TeachWord {
  std::string_view text;
  int column = 1;  // from 1, in bytes
};

class TeachLines {
 public:
  static constexpr std::size_t kMostWords = 64;

  // `text` is used until the last call. A UTF-8 byte order mark is passed over.
  explicit TeachLines(std::string_view text);

  enum class Line : std::uint8_t {
    end,        // there is no further line
    words,      // words() of a statement
    script,     // script(): the text after a '%' at the beginning of the line
    too_long,   // more than kLongestTeachLine bytes
    too_many,   // more than kMostWords words
    unwritten,  // a byte that is no part of text at column()
  };
  // Passes over blank lines and comments. LF and CRLF.
  Line next();
  [[nodiscard]] int number() const { return number_; }  // of the line, from 1
  [[nodiscard]] int column() const { return column_; }
  [[nodiscard]] std::span<const TeachWord> words() const { return {words_.data(), word_count_}; }
  [[nodiscard]] TeachWord script() const { return script_; }

 private:
  Line split(std::string_view line);

  std::string_view rest_;
  int number_ = 0;
  int column_ = 1;
  std::array<TeachWord, kMostWords> words_;
  std::size_t word_count_ = 0;
  TeachWord script_;
};

}  // namespace cellmirror::program
