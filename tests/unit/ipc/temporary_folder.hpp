// A folder of the test's own that goes away with it.
#pragma once

#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace cellmirror::test {

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "cellmirror-test-XXXXXX").native();
    path_ = ::mkdtemp(name.data());
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  // Writes `text` to `name` and makes the folders on the way.
  void write(const std::filesystem::path& name, std::string_view text) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << text;
  }

 private:
  std::filesystem::path path_;
};

// Makes this process's gateways keep their files in a folder of the test.
class PrivateRuntimeFolder {
 public:
  PrivateRuntimeFolder() { ::setenv("CELLMIRROR_RUNTIME_DIR", (folder_.path() / "run").c_str(), 1); }
  ~PrivateRuntimeFolder() { ::unsetenv("CELLMIRROR_RUNTIME_DIR"); }

  [[nodiscard]] std::filesystem::path path() const { return folder_.path() / "run"; }

 private:
  TemporaryFolder folder_;
};

}  // namespace cellmirror::test
