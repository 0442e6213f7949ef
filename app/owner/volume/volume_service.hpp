// SCRIPT's commands for voxel volumes (manual 1.2.7): checks names and keeps what is in force for each volume. Belongs
// to the thread that owns the cell.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "rt_core/base/result.hpp"
#include "rt_core/cell/cell.hpp"
#include "rt_core/ports/volume_state.hpp"
#include "scripts/commands/volume_host.hpp"

namespace cellmirror::app {

// Reads the users' tables of the cell folder; a table without a file is none.
using VolumeTableReader = std::function<Result<VolumeUserTables>()>;

class VolumeService final : public VolumeHost {
 public:
  // `cell` outlives this. Tables that cannot be read now are none, which is logged.
  VolumeService(const Cell& cell, VolumeTableReader read_tables);

  Result<std::string> set_plane_mode(std::size_t plane, VolumePlaneMode mode, std::string_view volume) override;
  Result<std::string> set_plane_position(std::size_t plane, const VolumePlanePosition& position,
                                         std::string_view volume) override;
  Result<std::string> set_table(VolumeTable table, std::string_view volume) override;
  Result<std::string> set_medical_table(const MedicalTableParameters& parameters, std::string_view volume) override;
  Result<std::string> set_table_parameters(VolumeTable table, const VolumeTableParameters& parameters,
                                           std::string_view volume) override;
  Result<std::string> set_surface(bool on, std::optional<double> value, std::string_view volume) override;
  Result<std::string> reload_tables(std::string_view volume) override;

  // After components were loaded or deleted: a volume that comes has the settings of its file.
  void follow_cell();
  // Of all volumes in memory. The same object as long as nothing changes.
  [[nodiscard]] const std::shared_ptr<const VolumeStates>& states();

 private:
  void read_first_tables();
  Result<void> take_tables();  // a refused one changes nothing
  // Makes `change` to the volume of this name, or to all. The answer is the remark: that of `remark` for the volumes
  // concerned, once each.
  Result<std::string> apply(std::string_view volume, const std::function<void(VolumeState&)>& change,
                            const std::function<std::string(const VolumeState&)>& remark = {});

  const Cell& cell_;
  VolumeTableReader read_tables_;
  VolumeUserTables tables_;  // as read last
  std::uint64_t tables_revision_ = 0;
  std::shared_ptr<const CompiledCell> followed_;  // whose volumes states_ has
  std::shared_ptr<const VolumeStates> states_ = std::make_shared<VolumeStates>();
};

}  // namespace cellmirror::app
