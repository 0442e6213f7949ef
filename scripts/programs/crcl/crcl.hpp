// CRCL, the canonical robot command language of NIST: programs as XML (docs/languages/crcl.md).
#pragma once

#include "scripts/programs/program/language.hpp"

namespace cellmirror::program {

[[nodiscard]] const Language& crcl_language();

}  // namespace cellmirror::program
