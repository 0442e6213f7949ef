// A tile in words, for people.
#pragma once

#include <string>
#include <string_view>

#include "app/wall/wall_cells.hpp"

namespace cellmirror::app {

// "conflict", "wrong_gateway", ...
[[nodiscard]] std::string_view word(WallMark mark);
// What is wrong, and what can be done, in a sentence.
[[nodiscard]] std::string mark_text(const WallTile& tile, WallMark mark);
// "ok", "attention", "fault", "silent" or "never seen".
[[nodiscard]] std::string_view state_word(const WallTile& tile);

}  // namespace cellmirror::app
