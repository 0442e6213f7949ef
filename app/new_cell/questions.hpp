// Asks a person on the terminal for what the command line did not say. Each question shows what an empty answer means.
#pragma once

#include <istream>
#include <ostream>

#include "app/new_cell/request.hpp"

namespace cellmirror::app {

// What the command line has said is not asked again.
struct Told {
  bool xyz = false;
  bool channel = false;
};

// False where the input ends before every question is answered. An answer that makes no sense is asked for again, at
// most kMostTries times.
[[nodiscard]] bool ask_for_rest(NewCellRequest& request, Told told, std::istream& in, std::ostream& out);

}  // namespace cellmirror::app
