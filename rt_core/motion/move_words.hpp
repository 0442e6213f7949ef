// The words of moves and of how they ended, as status and simulation reports have them.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

#include "rt_core/motion/executor.hpp"
#include "rt_core/motion/move.hpp"

namespace cellmirror::motion {

// Each table is in the order of its enumeration.
inline constexpr std::array<std::string_view, 4> kMoveKindWords = {"joints", "linear", "circular", "delay"};
inline constexpr std::array<std::string_view, 5> kOutcomeWords = {"none", "arrived", "stopped", "superseded",
                                                                  "blocked"};

static_assert(kMoveKindWords.size() == std::size_t{std::to_underlying(MoveKind::delay)} + 1);
static_assert(kOutcomeWords.size() == std::size_t{std::to_underlying(Outcome::blocked)} + 1);

[[nodiscard]] constexpr std::string_view word(MoveKind kind) { return kMoveKindWords.at(std::to_underlying(kind)); }
[[nodiscard]] constexpr std::string_view word(Outcome outcome) { return kOutcomeWords.at(std::to_underlying(outcome)); }

}  // namespace cellmirror::motion
