// The teach-and-repeat languages jet_boom and jet_tarm (docs/languages/jet.md).
#pragma once

#include "scripts/programs/program/language.hpp"

namespace cellmirror::program {

[[nodiscard]] const Language& jet_boom_language();
[[nodiscard]] const Language& jet_tarm_language();

}  // namespace cellmirror::program
