// A file of records that is written whole or not at all: compressed where its name ends in .gz.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string_view>

#include "rt_core/base/result.hpp"

namespace cellmirror::app {

// Written as FILE.part and renamed by finish(). Only its owner can read it (0600). What is called FILE.part before is
// removed, never followed or written to; FILE.part itself is removed where anything fails, or finish() is not called.
class RecordFile {
 public:
  static Result<RecordFile> create(const std::filesystem::path& file);
  RecordFile(RecordFile&&) noexcept;
  RecordFile& operator=(RecordFile&&) = delete;
  ~RecordFile();

  // After a failure everything fails, with the first reason.
  [[nodiscard]] Result<void> write(std::string_view text);
  [[nodiscard]] Result<void> finish();

 private:
  struct State;
  explicit RecordFile(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

// Removes the oldest files PREFIX<number>... of the folder, by that number, until `kept` are left, and what an
// interrupted write left of them (.part); 0 where nothing can be listed. Returns how many were removed.
std::size_t remove_old_records(const std::filesystem::path& folder, std::string_view prefix, std::size_t kept);

}  // namespace cellmirror::app
