// Reads [[io_node]] and [[light_barrier]] tables. Private to this folder.
#pragma once

#include <string>
#include <vector>

#include "config/component_files.hpp"
#include "config/file_finder.hpp"
#include "config/table_reader.hpp"
#include "rt_core/cell/cell.hpp"
#include "rt_core/ports/io_config.hpp"
#include "rt_core/ports/light_barrier.hpp"

namespace cellmirror {

class IoReader {
 public:
  // Takes the tables.
  void read(TableReader& top);
  // When the robots are known. `complete`: all robots of the cell are in `robots`.
  void read_nodes(const RobotDirectory& robots, bool complete, const FileFinder& files);
  // When the cell is there: full paths of the barriers' frames; unknown frames and sensors are errors.
  void complete(const Cell& cell, Diagnostics& diagnostics);

  std::vector<IoNodeConfig> nodes;
  std::vector<LightBarrier> barriers;

 private:
  struct BarrierPlaces {
    Place from;
    Place to;
  };
  struct NamedSensor {
    std::string name;
    Place place;
  };

  void read_barrier(TableReader& table);
  void read_node(TableReader& table, const RobotDirectory& robots, bool complete, const FileFinder& files);
  void read_input(TableReader& table, const RobotDirectory& robots, bool complete, IoNodeConfig& node);
  void read_analogue(TableReader& table, IoNodeConfig& node);
  void read_output(TableReader& table, const RobotDirectory& robots, bool complete, IoNodeConfig& node);

  std::vector<TableReader> node_tables_;
  std::vector<BarrierPlaces> places_;
  std::vector<NamedSensor> sensors_;  // that inputs name
};

}  // namespace cellmirror
