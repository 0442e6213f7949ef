#include "scripts/programs/srcl/faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "rt_core/base/text.hpp"

namespace cellmirror::program::srcl {

void Faults::add(std::uint32_t line, std::uint32_t column, std::string message, std::string remedy) {
  found_.error({file_, static_cast<int>(line), static_cast<int>(column)}, std::move(message), std::move(remedy));
}

std::string Faults::proposal(std::string_view wrong, const std::vector<std::string>& candidates,
                             std::string_view otherwise) {
  std::string text;
  // To a single letter everything short is near.
  if (wrong.size() > 1 && may_propose(candidates.size())) {
    proposals_left_ -= candidates.size();
    text = did_you_mean(wrong, candidates);
  }
  return text.empty() ? std::string(otherwise) : text;
}

void Faults::hand_over(Diagnostics& diagnostics) const {
  std::vector<Diagnostic> sorted = found_.all();
  const auto position = [](const Diagnostic& d) { return std::tuple(d.place.line, d.place.column); };
  std::ranges::stable_sort(sorted, {}, position);
  for (Diagnostic& diagnostic : sorted) diagnostics.add(std::move(diagnostic));
  // Those that were only counted: they are only counted there, too.
  for (std::size_t i = sorted.size(); i < found_.errors(); ++i) diagnostics.error({}, {});
}

std::string shown(const Token& token) {
  if (token.kind == TokenKind::end_of_line || token.kind == TokenKind::end_of_text) return "the end of the line";
  return fmt::format("'{}'", printable(token.text, 40));
}

}  // namespace cellmirror::program::srcl
