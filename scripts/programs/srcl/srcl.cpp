#include "scripts/programs/srcl/srcl.hpp"

#include <fmt/format.h>

#include <exception>

#include "scripts/programs/srcl/parser.hpp"

namespace cellmirror::program {

namespace {

std::shared_ptr<const Program> parse_srcl(std::string_view text, const ParseContext& context,
                                          Diagnostics& diagnostics) {
  if (text.size() > kLargestProgramText) {
    diagnostics.error({context.file}, fmt::format("the program is larger than {} MiB", kLargestProgramText >> 20U),
                      "divide it into several programs");
    return nullptr;
  }
  try {
    return srcl::Parser(text, context).run(diagnostics);
  } catch (const std::exception& error) {  // no memory
    diagnostics.error({context.file}, fmt::format("the program cannot be read: {}", error.what()));
    return nullptr;
  }
}

}  // namespace

const Language& srcl_language() {
  static const Language language = {
      "srcl", "textual motion language, our own dialect (docs/languages/srcl.md)", {".src"}, {}, &parse_srcl};
  return language;
}

}  // namespace cellmirror::program
