// A cell's home in a folder of its own below the test's temporary folder; removed afterwards.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace cellmirror {

class TemporaryHome {
 public:
  TemporaryHome() {
    static int count = 0;
    root_ = std::filesystem::path(testing::TempDir()) /
            ("cellmirror_config_" + std::to_string(getpid()) + "_" + std::to_string(++count));
    for (const char* folder : {"envlib", "scripts", "robots"}) std::filesystem::create_directories(root_ / folder);
  }
  ~TemporaryHome() { std::filesystem::remove_all(root_); }
  TemporaryHome(const TemporaryHome&) = delete;
  TemporaryHome& operator=(const TemporaryHome&) = delete;

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    const std::filesystem::path path = root_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }
  const std::filesystem::path& root() const { return root_; }

 private:
  std::filesystem::path root_;
};

}  // namespace cellmirror
