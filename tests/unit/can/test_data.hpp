// Where the tests' input files lie.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace cellmirror {

inline std::filesystem::path source_dir() {
  const char* given = std::getenv("CELLMIRROR_SOURCE_DIR");
  return given != nullptr ? std::filesystem::path(given) : std::filesystem::current_path();
}

inline std::string can_data(const std::string& file) { return (source_dir() / "tests/data/can" / file).string(); }

// Files of others, which a machine may lack: the test skips itself visibly.
inline std::filesystem::path shared_data() {
  if (const char* given = std::getenv("CELLMIRROR_SHARED_DATA"); given != nullptr) return given;
  return source_dir() / "../shared/data";
}

}  // namespace cellmirror
