// Reads [tissue] and [[deformable]] of a cell file. Private to this folder.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "config/table_reader.hpp"
#include "config/tissue_setup.hpp"
#include "rt_core/cell/cell.hpp"

namespace cellmirror {

class FileFinder;

class TissueReader {
 public:
  // The keys alone.
  void read(TableReader& top, const FileFinder& files);
  // The files that they name, with errors in these. The table of read() still exists.
  void read_files(const FileFinder& files, Diagnostics& of_files);
  // With the objects at their places in the cell at its start. Errors: unknown frames.
  [[nodiscard]] TissueSetup setup(const Cell& cell, Diagnostics& diagnostics);

 private:
  struct Placed {
    TableReader table;
    std::string name;            // of the object, for messages
    std::filesystem::path file;  // empty: refused
    std::string predecessor;     // path of a frame; empty: the world
    Pose X_PO = Pose::Identity();
  };

  void read_deformable(TableReader& table, const FileFinder& files);

  std::vector<Placed> placed_;
  std::vector<std::pair<std::size_t, tissue::ObjectDescription>> objects_;  // with their index in placed_
  std::filesystem::path hyper_file_;
  std::vector<tissue::Connection> connections_;
};

}  // namespace cellmirror
