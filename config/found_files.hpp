// The files that were found while a cell was read: what another machine needs to read it too. Private to this folder.
#pragma once

#include <cstddef>
#include <filesystem>
#include <set>
#include <vector>

namespace cellmirror {

class FoundFiles {
 public:
  static constexpr std::size_t kMost = 10'000;  // more are not noted

  // Canonical paths; each is noted once.
  void note(const std::filesystem::path& file) {
    if (seen_.size() < kMost && seen_.insert(file).second) files_.push_back(file);
  }
  // In the order in which they were found.
  [[nodiscard]] const std::vector<std::filesystem::path>& files() const { return files_; }

 private:
  std::set<std::filesystem::path> seen_;
  std::vector<std::filesystem::path> files_;
};

}  // namespace cellmirror
