#include "config/tissue_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "config/file_finder.hpp"
#include "config/hyper_file.hpp"
#include "config/tissue_object.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

constexpr Range kObjectPlace{-1000.0, 1000.0};

}  // namespace

void TissueReader::read_deformable(TableReader& table, const FileFinder& files) {
  table.require("object");
  const auto name = table.text("object");
  if (name) table.set_where("object " + printable(*name));
  Placed placed{table, {}, {}, {}, Pose::Identity()};
  const Eigen::Vector3d xyz = table.vector3("xyz_m", kObjectPlace).value_or(Eigen::Vector3d::Zero());
  placed.X_PO = pose_from_xyz_rpy(xyz, table.vector3("rpy_rad").value_or(Eigen::Vector3d::Zero()));
  placed.predecessor = table.text("predecessor").value_or("");
  table.finish();
  if (!name) return;
  const auto found = files.find(FileUse::object, *name);
  if (!found) return table.error("object", found.error().what, found.error().remedy);
  if (!equal_ignoring_case(found->extension().string(), kObjectExtension))
    return table.error("object", fmt::format("{} is no deformable object", printable(*name)), "objects are .mpo files");
  placed.name = found->filename().string();
  placed.file = *found;
  if (std::ranges::find(placed_, placed.name, &Placed::name) != placed_.end()) {
    return table.error("object", fmt::format("there is another object {}", placed.name),
                       "SCRIPT names objects by their files: copy the file under another name");
  }
  placed_.push_back(std::move(placed));
}

void TissueReader::read(TableReader& top, const FileFinder& files) {
  for (TableReader& table : top.tables("deformable", kMostObjects)) read_deformable(table, files);
  auto table = top.table("tissue");
  if (!table) return;
  if (const auto hyper = table->text("hyper")) {
    const auto found = files.find(FileUse::hyper, *hyper);
    if (found) {
      hyper_file_ = *found;
    } else {
      table->error("hyper", found.error().what, found.error().remedy);
    }
  }
  table->finish();
}

void TissueReader::read_files(const FileFinder& files, Diagnostics& of_files) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    names.push_back(placed_[i].name);
    if (auto object = read_object(placed_[i].file, files, of_files)) objects_.emplace_back(i, std::move(*object));
  }
  if (hyper_file_.empty()) return;
  if (auto hyper = read_hyper(hyper_file_, &names, of_files)) connections_ = std::move(hyper->connections);
}

TissueSetup TissueReader::setup(const Cell& cell, Diagnostics& diagnostics) {
  TissueSetup out;
  for (auto& [index, object] : objects_) {
    const Placed& placed = placed_[index];
    object.X_WO = placed.X_PO;
    if (!placed.predecessor.empty()) {
      if (const auto frame = cell.find(placed.predecessor)) {
        object.X_WO = cell.world_pose(*frame, cell.start_positions()) * placed.X_PO;
      } else {
        diagnostics.error(placed.table.place("predecessor"), frame.error().what, frame.error().remedy);
      }
    }
    out.objects.push_back(std::move(object));
  }
  out.connections = std::move(connections_);
  out.hyper_file = hyper_file_.string();
  return out;
}

}  // namespace cellmirror
