// Reads teach files. docs/languages/jet.md has the grammar.
#pragma once

#include <memory>
#include <string_view>

#include "rt_core/base/diagnostics.hpp"
#include "scripts/programs/jet/teach_file.hpp"
#include "scripts/programs/program/language.hpp"
#include "scripts/programs/program/program.hpp"

namespace cellmirror::program {

// Language::parse() of both dialects. A file of the other dialect is reported and read by its own rules, so that its
// other errors are found as well.
[[nodiscard]] std::shared_ptr<const Program> parse_teach_file(TeachDialect dialect, std::string_view text,
                                                              const ParseContext& context, Diagnostics& diagnostics);

}  // namespace cellmirror::program
