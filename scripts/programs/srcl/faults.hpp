// Errors of a program, collected while it is read and passed on in the order of the lines.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/diagnostics.hpp"
#include "scripts/programs/srcl/lexer.hpp"

namespace cellmirror::program::srcl {

class Faults {
 public:
  explicit Faults(std::string file) : file_(std::move(file)) {}

  void add(std::uint32_t line, std::uint32_t column, std::string message, std::string remedy = {});
  void add(const Token& at, std::string message, std::string remedy = {}) {
    add(at.line, at.column, std::move(message), std::move(remedy));
  }
  // "did you mean A or B?", or `otherwise`. The work of all proposals together is bounded, so that a text full of
  // unknown names is read in linear time.
  [[nodiscard]] std::string proposal(std::string_view wrong, const std::vector<std::string>& candidates,
                                     std::string_view otherwise);
  // Whether the number of candidates permits a search for proposals.
  [[nodiscard]] bool may_propose(std::size_t candidates) const { return candidates <= proposals_left_; }
  [[nodiscard]] std::size_t count() const { return found_.errors(); }
  void move_to(Diagnostics& diagnostics) const;

 private:
  static constexpr std::size_t kMostComparisons = 100'000;

  std::string file_;
  Diagnostics found_;
  std::size_t proposals_left_ = kMostComparisons;
};

// As people should see it: in quotes, or "the end of the line".
[[nodiscard]] std::string shown(const Token& token);

}  // namespace cellmirror::program::srcl
