// `cellmirror collide --pairs`: which pairs of bodies are tested, and why the others are not.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

#include "rt_core/collision/pairs.hpp"

namespace cellmirror::app {

// "tested", "neighbours", ...: the words of docs/collisions.md.
[[nodiscard]] std::string_view word_of(collision::PairState state);

void print_pairs(const std::string& cell, const collision::PairTable& pairs, std::FILE* out);
void print_pairs_json(const std::string& cell, const collision::PairTable& pairs, std::FILE* out);

}  // namespace cellmirror::app
