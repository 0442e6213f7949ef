// How far the loading of a cell has come, on the terminal.
#pragma once

#include "app/console/progress_line.hpp"
#include "config/cell_file.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::app {

// For load_cell() and check_file(); `line` outlives it.
inline LoadProgress load_progress(ProgressLine& line) {
  return [&line](std::size_t done, std::size_t total, std::string_view what) {
    line.update(done, total, printable(what, 60));
  };
}

}  // namespace cellmirror::app
