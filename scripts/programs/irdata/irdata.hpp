// IRDATA: our dialect of the numbered records of VDI 2863 (docs/languages/irdata.md has its grammar).
#pragma once

#include "scripts/programs/program/language.hpp"

namespace cellmirror::program {

// For the list of languages. ParseContext::codes: text of a table of operation codes in place of the built-in one
// (config/languages/irdata_codes.tsv); its errors are reported with the place in the table. Any thread.
[[nodiscard]] const Language& irdata_language();

}  // namespace cellmirror::program
