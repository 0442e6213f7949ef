// SRCL, a textual motion language. The language that bore this name is not public: the words and the grammar here are
// our own (docs/languages/srcl.md), in the style of its family.
#pragma once

#include "scripts/programs/program/language.hpp"

namespace cellmirror::program {

[[nodiscard]] const Language& srcl_language();

}  // namespace cellmirror::program
