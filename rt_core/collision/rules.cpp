#include "rt_core/collision/rules.hpp"

#include <fmt/core.h>

#include <ranges>
#include <string_view>

namespace cellmirror::collision {

namespace {

// `branch` means itself and everything named below it; empty: the world, so everything.
bool in_branch(std::string_view path, std::string_view branch) {
  return branch.empty() || (path.starts_with(branch) && (path.size() == branch.size() || path[branch.size()] == '.'));
}

std::string_view shown(const std::string& branch) { return branch.empty() ? "everything" : std::string_view(branch); }

}  // namespace

RuleFinder::RuleFinder(std::span<const PairRule> rules, const PairTable& table) {
  for (const PairRule& rule : rules | std::views::reverse) {
    Sides& found = rules_.emplace_back();
    found.rule = &rule;
    for (const std::string& name : *table.names) {
      const int side = (in_branch(name, rule.a) ? 1 : 0) + (in_branch(name, rule.b) ? 2 : 0);
      found.sides.push_back(static_cast<std::uint8_t>(side));
    }
  }
}

const PairRule* RuleFinder::last_that_fits(std::uint32_t a, std::uint32_t b) const {
  for (const Sides& candidate : rules_) {
    const unsigned side_a = candidate.sides[a];
    const unsigned side_b = candidate.sides[b];
    if (((side_a & 1U) != 0 && (side_b & 2U) != 0) || ((side_a & 2U) != 0 && (side_b & 1U) != 0)) return candidate.rule;
  }
  return nullptr;
}

std::string rule_text(const PairRule& rule) {
  const std::string_view verb = rule.kind == PairRule::Kind::ignore ? "ignored" : "tested";
  std::string text = fmt::format("{} by the rule for {} and {}", verb, shown(rule.a), shown(rule.b));
  if (!rule.reason.empty()) text += ": " + rule.reason;
  return text;
}

}  // namespace cellmirror::collision
