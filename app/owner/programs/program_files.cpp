#include "app/owner/programs/program_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <system_error>
#include <vector>

#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 2> kProgramFolders = {kProgramFolder, "scripts"};
constexpr std::size_t kLargestCodes = std::size_t{1} << 20;  // bytes

std::vector<std::string> names_to_try(const program::Language& language, std::string_view name) {
  std::vector<std::string> names = {std::string(name)};
  for (const std::string_view extension : language.extensions) names.push_back(names.front() + std::string(extension));
  return names;
}

std::string codes_of(const KismetHome& home, const program::Language& language) {
  if (language.codes_file.empty()) return {};
  for (const std::string_view folder : kProgramFolders) {
    const auto path = home.file(folder, language.codes_file);
    if (!path) continue;
    if (auto text = read_text_file(*path, kLargestCodes)) return *std::move(text);
  }
  return {};
}

}  // namespace

Result<fs::path> find_program_file(const KismetHome& home, const program::Language& language, std::string_view name) {
  const std::vector<std::string> names = names_to_try(language, name);
  for (const std::string_view folder : kProgramFolders) {
    for (const std::string& candidate : names) {
      if (home.has(folder, candidate)) return home.file(folder, candidate);  // refuses what leaves the home
    }
  }
  std::string tried;
  for (const std::string& candidate : names) tried += (tried.empty() ? "" : ", ") + printable(candidate);
  std::string near;
  for (const std::string_view folder : kProgramFolders) {
    if (near.empty()) near = home.nearest_files(folder, name, language.extensions);
  }
  if (!near.empty()) near += " ";
  return fail(fmt::format("there is no {} program {} in the folders programs and scripts of the cell's home {}",
                          language.name, printable(name), home.root().string()),
              fmt::format("{}looked for {}; ROBOT_LANGUAGE sets the language", near, tried));
}

ProgramText read_program(const KismetHome& home, const program::Language& language, const fs::path& path) {
  ProgramText read;
  const auto text = read_text_file(path, program::kLargestProgramText);
  if (!text) {
    read.program = std::unexpected(text.error());
    return read;
  }
  program::ParseContext context;
  context.file = home.shown_name(path);
  context.codes = codes_of(home, language);
  read.program = language.parse(*text, context, read.findings);
  if (*read.program != nullptr && read.findings.ok()) return read;
  const auto& all = read.findings.all();
  const auto first = std::ranges::find(all, Severity::error, &Diagnostic::severity);
  const std::size_t errors = read.findings.errors();
  read.program = fail(fmt::format("{} has {} error{}, it is not loaded; the first: {}", context.file, errors,
                                  errors == 1 ? "" : "s", first == all.end() ? std::string("unknown") : first->text()),
                      fmt::format("`cellmirror check --language {} FILE` shows all of them", language.name));
  return read;
}

}  // namespace cellmirror::app
