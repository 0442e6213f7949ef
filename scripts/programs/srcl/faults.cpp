#include "scripts/programs/srcl/faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
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

void Faults::move_to(Diagnostics& diagnostics) const {
  const std::vector<Diagnostic>& found = found_.all();
  std::vector<std::size_t> order(found.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {},
                    [&found](std::size_t i) { return std::tuple(found[i].place.line, found[i].place.column, i); });
  for (const std::size_t i : order) diagnostics.add(found[i]);
  // Those that were only counted: they are only counted there, too.
  for (std::size_t i = found.size(); i < found_.errors(); ++i) diagnostics.error({}, {});
}

std::string shown(const Token& token) {
  if (token.kind == TokenKind::end_of_line || token.kind == TokenKind::end_of_text) return "the end of the line";
  return fmt::format("'{}'", printable(token.text, 40));
}

}  // namespace cellmirror::program::srcl
