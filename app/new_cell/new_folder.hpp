// A folder that appears whole or not at all: it is filled under a temporary name beside its place and then renamed.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "app/new_cell/plan.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::app {

class NewFolder {
 public:
  // Makes the temporary folder. Refused: where there is anything at `place` already, and where the folder above it is
  // missing. Signals that end a process wait from here on until the destructor.
  static Result<std::unique_ptr<NewFolder>> make(const std::filesystem::path& place);
  ~NewFolder();  // removes what was not put in place
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  // Copies or writes one file, with the folders above it.
  [[nodiscard]] Result<void> add(const PlannedFile& file);
  // Renames it to its place; refused where something has appeared there meanwhile, or a signal came to end the program.
  [[nodiscard]] Result<void> put_in_place();

 private:
  struct Signals;
  NewFolder(std::filesystem::path place, std::filesystem::path path, std::unique_ptr<Signals> signals);

  std::filesystem::path place_;
  std::filesystem::path path_;  // empty: in place
  std::unique_ptr<Signals> signals_;
};

}  // namespace cellmirror::app
