#include "scripts/programs/rapid/rapid.hpp"

#include <fmt/format.h>

#include <exception>

#include "scripts/programs/rapid/parser.hpp"

namespace cellmirror::program {
namespace {

std::shared_ptr<const Program> parse(std::string_view text, const ParseContext& context, Diagnostics& diagnostics) {
  if (text.size() > kLargestProgramText) {
    diagnostics.error({.file = context.file},
                      fmt::format("the program is larger than {} MiB", kLargestProgramText >> 20U),
                      "divide it into several programs");
    return nullptr;
  }
  try {
    return rapid::Parser(text, context).run(diagnostics);
  } catch (const std::exception& error) {  // no memory
    diagnostics.error({.file = context.file}, fmt::format("the program cannot be read: {}", error.what()));
    return nullptr;
  }
}

}  // namespace

const Language& rapid_language() {
  static const Language rapid_entry = {.name = "rapid",
                                       .summary = "a subset of ABB's RAPID (docs/languages/rapid.md)",
                                       .extensions = {".mod", ".prg", ".modx"},
                                       .codes_file = {},
                                       .parse = &parse};
  return rapid_entry;
}

}  // namespace cellmirror::program
