#include "app/subcommands/check_programs.hpp"

#include <fmt/format.h>

#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

#include "app/subcommands/check_program_fit.hpp"
#include "rt_core/base/home.hpp"
#include "scripts/programs/languages/languages.hpp"

namespace cellmirror::app {

namespace {

constexpr std::size_t kLargestCodes = std::size_t{1} << 20;

// Empty: the built-in table.
Result<std::string> codes_beside(const std::filesystem::path& path, const program::Language& language) {
  if (language.codes_file.empty()) return std::string();
  const std::filesystem::path codes = path.parent_path() / language.codes_file;
  std::error_code error;
  if (!std::filesystem::exists(codes, error)) return std::string();
  return read_text_file(codes, kLargestCodes);
}

}  // namespace

std::vector<std::string> language_names() {
  std::vector<std::string> names;
  for (const program::Language& language : program::languages()) names.emplace_back(language.name);
  return names;
}

std::string program_extensions() {
  std::string text;
  for (const program::Language& language : program::languages()) {
    for (const std::string_view extension : language.extensions) {
      if (program::language_of_extension(extension) == nullptr) continue;
      text += (text.empty() ? "" : " ") + std::string(extension);
    }
  }
  return text;
}

void check_robot_program(const std::filesystem::path& path, const program::Language& language,
                         const ProgramSurroundings& around, Diagnostics& diagnostics) {
  const auto text = read_text_file(path, program::kLargestProgramText);
  auto codes = codes_beside(path, language);
  if (!text) diagnostics.error({path.string()}, text.error().what, text.error().remedy);
  if (!codes) diagnostics.error({path.string()}, codes.error().what, codes.error().remedy);
  if (!text || !codes) return;
  std::shared_ptr<const program::Program> program;
  language.parse(*text, {path.string(), std::move(*codes), &program}, diagnostics);
  if (!program) return;
  check_program_comments(*program, around.cell, around.names, diagnostics);
  if (around.robot != nullptr) check_program_fit(*program, *around.robot, diagnostics);
}

void check_language(const std::filesystem::path& path, const program::Language& language, Diagnostics& diagnostics) {
  const program::Language* named = program::language_of_extension(path.extension().string());
  if (named == nullptr || named == &language) return;
  diagnostics.warning({path.string()},
                      fmt::format("the file's name says {}, but it is read as {}", named->name, language.name),
                      fmt::format("`--language {}` reads it as its name says", named->name));
}

}  // namespace cellmirror::app
