// Reads the words of one statement of a teach file, with diagnostics of invalid ones.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "rt_core/base/diagnostics.hpp"
#include "scripts/programs/jet/teach_lines.hpp"
#include "scripts/programs/jet/teach_program.hpp"

namespace cellmirror::program {

class TeachWords {
 public:
  // `words` is not empty; both are used until the last call.
  TeachWords(std::span<const TeachWord> words, int line, const std::string& file, Diagnostics& diagnostics)
      : words_(words), line_(line), file_(file), diagnostics_(diagnostics) {}

  [[nodiscard]] bool at_end() const { return next_ == words_.size(); }
  [[nodiscard]] const TeachWord& peek() const { return words_[next_]; }
  const TeachWord& take() { return words_[next_++]; }
  [[nodiscard]] bool peek_is(std::string_view keyword) const;
  void skip_rest() { next_ = words_.size(); }
  // Reports text after the statement.
  void expect_end();

  // What follows has to be there and in order; none, and a finding, where it is not. `what` names it: "SPEED".
  std::optional<TeachWord> name(std::string_view what);
  std::optional<double> number(std::string_view what, double least, double most);
  std::optional<long long> integer(std::string_view what, long long least, long long most);
  std::optional<bool> on_or_off(std::string_view what);
  // "SPEED ...", "ACCELERATION ..." or "TOLERANCE ...": read into `settings`. False where none of them is next.
  bool setting(TeachSettings& settings);

  void error(const TeachWord& word, std::string message, std::string remedy = {});
  [[nodiscard]] Place place(int column) const { return {file_, line_, column}; }

 private:
  void share(std::string_view what, std::optional<double>& share);
  void tolerance(std::optional<TeachTolerance>& tolerance);
  void missing(std::string_view what, std::string_view example);  // behind the last word

  std::span<const TeachWord> words_;
  std::size_t next_ = 0;
  int line_;
  const std::string& file_;
  Diagnostics& diagnostics_;
};

}  // namespace cellmirror::program
