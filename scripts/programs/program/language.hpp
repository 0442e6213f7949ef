// A robot language: what its folder gives to the list of languages (scripts/programs/languages).
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/diagnostics.hpp"
#include "scripts/programs/program/program.hpp"

namespace cellmirror::program {

inline constexpr std::size_t kLargestProgramText = std::size_t{64} << 20;  // bytes; larger ones are refused

struct ParseContext {
  std::string file;  // for diagnostics and for the program's name where the text has none
  // Text of the language's table of codes where the user has one of his own; empty: the built-in one (irdata).
  std::string codes;
  // Receives the valid part of the program, also if it has errors and nothing is returned; null: not requested. Not to
  // be run: invalid parts are missing. Set to null if nothing could be read.
  std::shared_ptr<const Program>* read_part = nullptr;
};

struct Language {
  std::string_view name;                     // as in ROBOT_LANGUAGE
  std::string_view summary;                  // one line
  std::vector<std::string_view> extensions;  // ".ird"; the first one is added to names without
  std::string_view codes_file;               // "irdata_codes.tsv": searched beside the programs; empty: none
  // Reads all of the text and reports all that is wrong. Null where something is. Never throws; time and memory are
  // linear in the length of the text.
  std::shared_ptr<const Program> (*parse)(std::string_view text, const ParseContext& context, Diagnostics& diagnostics);
};

}  // namespace cellmirror::program
