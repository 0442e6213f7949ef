// Which rule of the settings applies to a pair.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "rt_core/collision/pairs.hpp"
#include "rt_core/collision/settings.hpp"

namespace cellmirror::collision {

// Rules and table outlive it.
class RuleFinder {
 public:
  RuleFinder(std::span<const PairRule> rules, const PairTable& table);

  // Null: none fits.
  [[nodiscard]] const PairRule* last_that_fits(std::uint32_t a, std::uint32_t b) const;

 private:
  struct Sides {
    const PairRule* rule = nullptr;
    std::vector<std::uint8_t> sides;  // by body: 1 in the branch of rule.a, 2 in that of rule.b, 3 in both
  };
  std::vector<Sides> rules_;  // the last first
};

[[nodiscard]] std::string rule_text(const PairRule& rule);

}  // namespace cellmirror::collision
