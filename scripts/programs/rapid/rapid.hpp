// A subset of ABB's RAPID (docs/languages/rapid.md). What is outside it is an error with its place.
#pragma once

#include "scripts/programs/program/language.hpp"

namespace cellmirror::program {

[[nodiscard]] const Language& rapid_language();

}  // namespace cellmirror::program
