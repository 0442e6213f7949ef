#include "scripts/programs/irdata/irdata.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>

#include "scripts/programs/irdata/code_table.hpp"
#include "scripts/programs/irdata/translator.hpp"

namespace cellmirror::program {

namespace {

constexpr std::string_view kCodesFile = "irdata_codes.tsv";

const irdata::CodeTable& own_codes() {
  static const irdata::CodeTable table = [] {
    Diagnostics none;  // a test reads the table; what were wrong with it would leave codes out
    return irdata::CodeTable::read(irdata::built_in_codes(), std::string(kCodesFile), none);
  }();
  return table;
}

std::shared_ptr<const Program> read_program(std::string_view text, const ParseContext& context,
                                            const irdata::CodeTable& codes, Diagnostics& diagnostics) {
  irdata::Translator translator(context, codes, diagnostics);
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  translator.expect_lines(static_cast<std::size_t>(std::ranges::count(text, '\n')) + 1);
  while (!text.empty() && !translator.cancelled()) {
    const std::size_t end = text.find('\n');
    translator.read_line(text.substr(0, end));
    if (end == std::string_view::npos) break;
    text.remove_prefix(end + 1);
  }
  return translator.finish(context.read_part);
}

std::shared_ptr<const Program> parse_irdata(std::string_view text, const ParseContext& context,
                                            Diagnostics& diagnostics) {
  if (text.size() > kLargestProgramText) {
    diagnostics.error({context.file, 0, 0}, fmt::format("the program has {} bytes", text.size()),
                      fmt::format("divide it; {} bytes is the maximum", kLargestProgramText));
    return nullptr;
  }
  try {
    if (context.codes.empty()) return read_program(text, context, own_codes(), diagnostics);
    const std::size_t errors = diagnostics.errors();
    const irdata::CodeTable codes = irdata::CodeTable::read(context.codes, std::string(kCodesFile), diagnostics);
    auto program = read_program(text, context, codes, diagnostics);
    return diagnostics.errors() == errors ? program : nullptr;
  } catch (const std::exception& failure) {
    diagnostics.error({context.file, 0, 0}, fmt::format("the program cannot be read: {}", failure.what()),
                      "divide it into smaller ones");
    return nullptr;
  }
}

}  // namespace

const Language& irdata_language() {
  static const Language language{
      "irdata", "numbered records in the manner of VDI 2863 (our dialect)", {".ird"}, kCodesFile, &parse_irdata};
  return language;
}

}  // namespace cellmirror::program
