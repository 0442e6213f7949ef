// The findings about faulty files, word by word. Each folder of bad/ holds a file to check (named in `check`) and what
// `cellmirror check` says about it (`expected`). After a wanted change of a message: CELLMIRROR_UPDATE_GOLDEN=1 writes
// the new texts, and the difference is read before it is committed.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "config/cell_file.hpp"

namespace cellmirror {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::vector<fs::path> cases() {
  std::vector<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(fs::path(__FILE__).parent_path() / "bad")) folders.push_back(entry);
  std::ranges::sort(folders);
  return folders;
}

struct Golden : testing::TestWithParam<fs::path> {};

TEST_P(Golden, findingsAreAsExpected) {
  const fs::path folder = fs::canonical(GetParam());
  std::string name = content(folder / "check");
  name.erase(name.find_last_not_of('\n') + 1);
  Diagnostics diagnostics;
  check_file(folder / name, diagnostics);
  EXPECT_FALSE(diagnostics.ok());
  std::string text = diagnostics.text();
  for (std::size_t at = 0; (at = text.find(folder.string(), at)) != std::string::npos;) {
    text.replace(at, folder.string().size(), "HOME");
  }
  if (std::getenv("CELLMIRROR_UPDATE_GOLDEN") != nullptr) std::ofstream(folder / "expected") << text;
  EXPECT_EQ(text, content(folder / "expected"));
}

INSTANTIATE_TEST_SUITE_P(Bad, Golden, testing::ValuesIn(cases()),
                         [](const auto& folder) { return folder.param.filename().string(); });

}  // namespace
}  // namespace cellmirror
