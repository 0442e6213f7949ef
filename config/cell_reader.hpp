// Reads the text of a cell file. Private to this folder.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/cell_file.hpp"
#include "config/collision_reader.hpp"
#include "config/component_files.hpp"
#include "config/io_reader.hpp"
#include "config/table_reader.hpp"
#include "config/tissue_reader.hpp"

namespace cellmirror {

class CellReader {
 public:
  CellReader(std::string file, const FileFinder& files) : file_(std::move(file)), files_(files) {}
  CellReader(const CellReader&) = delete;
  CellReader& operator=(const CellReader&) = delete;

  // Everything but the streams, controllers and haptic devices. False where the text is no TOML.
  bool read(std::string_view text);
  // `complete`: all robots of the cell are in `robots`.
  void read_streams(const RobotDirectory& robots, bool complete);
  void read_controllers(const RobotDirectory& robots, bool complete);
  // After the streams.
  void read_haptics(const RobotDirectory& robots, bool complete);

  std::string name;
  std::string description;
  Component root;
  Eigen::Vector3d gravity_m_s2 = kStandardGravity;
  LoopSettings loop;
  std::vector<RobotStream> streams;
  std::vector<RobotHaptic> haptics;
  IoReader io;
  std::vector<ControllerConfig> controllers;
  FootSwitchSettings foot_switches;
  DdsOutputConfig dds;
  RosPresence ros;
  DdsNetworkConfig dds_network;
  MqttConfig mqtt;
  QueueOverrides queues;
  WebSettings web;
  RecordSettings record;
  PictureSettings pictures;
  CollisionReader collision;
  TissueReader tissue;
  std::string startup_script;
  std::vector<ViewSetting> views;
  std::optional<std::filesystem::path> layout_file;  // which exists; not read yet
  Diagnostics findings;

 private:
  void read_loop(TableReader& top);
  void read_dds_output(TableReader& top);
  void read_queues(TableReader& top);
  void read_startup(TableReader& top);
  void read_views(TableReader& top);

  std::string file_;
  const FileFinder& files_;
  std::optional<toml::table> table_;
  std::vector<TableReader> stream_tables_;
  std::vector<TableReader> device_tables_;
  std::vector<TableReader> haptic_tables_;
  std::vector<TableReader> controller_tables_;
};

}  // namespace cellmirror
