#include "scripts/programs/jet/jet.hpp"

#include "scripts/programs/jet/teach_parser.hpp"

namespace cellmirror::program {

namespace {

template <TeachDialect dialect>
std::shared_ptr<const Program> parse(std::string_view text, const ParseContext& context, Diagnostics& diagnostics) {
  return parse_teach_file(dialect, text, context, diagnostics);
}

}  // namespace

const Language& jet_boom_language() {
  static const Language language{language_of(TeachDialect::boom),
                                 "teach and repeat: check points with a value for every joint",
                                 {".boom"},
                                 {},
                                 parse<TeachDialect::boom>};
  return language;
}

const Language& jet_tarm_language() {
  static const Language language{language_of(TeachDialect::tarm),
                                 "teach and repeat: check points that name the joints that move",
                                 {".tarm"},
                                 {},
                                 parse<TeachDialect::tarm>};
  return language;
}

}  // namespace cellmirror::program
