#include "app/owner/volume/volume_service.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>
#include <vector>

#include "app/owner/volume/volume_histogram.hpp"
#include "app/owner/volume/volume_names.hpp"
#include "config/volume_user_tables.hpp"
#include "rt_core/base/log.hpp"

namespace cellmirror::app {

namespace {

constexpr std::size_t kFirstUserTable = kVolumeTables - kVolumeUserTables;

std::string_view word(VolumeTable table) { return kVolumeTableWords.at(std::to_underlying(table)); }

void set_mode(VolumePlane& plane, VolumePlaneMode mode) {
  switch (mode) {
    case VolumePlaneMode::active:
      plane.side = VolumePlaneSide::beyond;
      break;
    case VolumePlaneMode::reverse:
      plane.side = VolumePlaneSide::before;
      break;
    case VolumePlaneMode::visible:
      plane.framed = true;
      break;
    case VolumePlaneMode::off:
      plane.side = VolumePlaneSide::none;
      plane.framed = false;
      break;
  }
}

// Of a table that becomes active.
std::string table_remark(const VolumeState& volume, VolumeTable table) {
  const std::size_t index = std::to_underlying(table);
  if (index < kFirstUserTable) return {};
  const std::size_t user = index - kFirstUserTable;
  if (volume.user_tables.at(user) != nullptr) return {};
  return fmt::format("the cell folder has no {}, so the volume is drawn as with {}", volume_table_file(user),
                     word(user == 0 ? VolumeTable::linear : VolumeTable::rainbow));
}

std::string parameter_remark(const VolumeState& volume, VolumeTable table) {
  if (volume.settings.table == table) return {};
  return fmt::format("{} is drawn with {}, so this is seen after VV_SET_LUT {}", volume.name,
                     word(volume.settings.table), word(table));
}

// The states of the volumes of `cell`: kept where the volume is the same as in `before`.
std::shared_ptr<const VolumeStates> states_of(const CompiledCell& cell, const CompiledCell* before,
                                              const VolumeStates& kept, const VolumeState& fresh) {
  auto states = std::make_shared<VolumeStates>();
  for (const CompiledVolume& volume : cell.volumes) {
    VolumeState state = fresh;
    state.name = cell.paths->at(static_cast<std::size_t>(volume.node));
    state.settings = volume.volume->settings;
    bool known = false;
    for (std::size_t i = 0; before != nullptr && i < before->volumes.size(); ++i) {
      if (before->volumes[i].volume != volume.volume || kept[i].name != state.name) continue;
      state = kept[i];
      known = true;
    }
    if (!known) state.histogram = std::make_shared<const VolumeHistogram>(histogram_of(*volume.volume->grid));
    states->push_back(std::move(state));
  }
  return states;
}

bool same_volumes(const CompiledCell& a, const CompiledCell& b) {
  return a.paths == b.paths && std::ranges::equal(a.volumes, b.volumes, [](const auto& x, const auto& y) {
           return x.node == y.node && x.volume == y.volume;
         });
}

}  // namespace

VolumeService::VolumeService(const Cell& cell, VolumeTableReader read_tables)
    : cell_(cell), read_tables_(std::move(read_tables)) {
  follow_cell();
}

// Before the first volume comes no table is needed.
void VolumeService::read_first_tables() {
  if (tables_revision_ != 0 || !read_tables_) return;
  tables_revision_ = 1;
  if (auto read = take_tables(); !read) log_warning("volume", "{}", read.error().text());
}

Result<void> VolumeService::take_tables() {
  auto read = read_tables_();
  if (!read) return std::unexpected(std::move(read.error()));
  tables_ = *std::move(read);
  return {};
}

void VolumeService::follow_cell() {
  auto compiled = cell_.compile();
  if (compiled == followed_) return;
  if (followed_ == nullptr || !same_volumes(*compiled, *followed_)) {
    if (!compiled->volumes.empty()) read_first_tables();
    VolumeState fresh;
    fresh.user_tables = tables_;
    fresh.tables_revision = tables_revision_;
    states_ = states_of(*compiled, followed_.get(), *states_, fresh);
  }
  followed_ = std::move(compiled);
}

const std::shared_ptr<const VolumeStates>& VolumeService::states() {
  follow_cell();
  return states_;
}

Result<std::string> VolumeService::apply(std::string_view volume, const std::function<void(VolumeState&)>& change,
                                         const std::function<std::string(const VolumeState&)>& remark) {
  follow_cell();
  if (states_->empty()) return std::unexpected(no_volumes());
  std::string only;
  if (!volume.empty()) {
    auto found = find_volume(cell_, volume);
    if (!found) return std::unexpected(std::move(found.error()));
    only = *std::move(found);
  }
  auto changed = std::make_shared<VolumeStates>(*states_);
  std::string remarks;
  std::set<std::string, std::less<>> given;
  for (VolumeState& state : *changed) {
    if (!only.empty() && state.name != only) continue;
    change(state);
    std::string text = remark ? remark(state) : std::string();
    if (text.empty() || !given.insert(text).second) continue;
    remarks += (remarks.empty() ? "" : "; ") + std::move(text);
  }
  states_ = std::move(changed);
  return remarks;
}

Result<std::string> VolumeService::set_plane_mode(std::size_t plane, VolumePlaneMode mode, std::string_view volume) {
  return apply(volume, [=](VolumeState& state) { set_mode(state.settings.planes.at(plane), mode); });
}

Result<std::string> VolumeService::set_plane_position(std::size_t plane, const VolumePlanePosition& position,
                                                      std::string_view volume) {
  return apply(
      volume,
      [&](VolumeState& state) {
        VolumePlane& set = state.settings.planes.at(plane);
        set.elevation_rad = position.elevation_rad;
        set.azimuth_rad = position.azimuth_rad;
        set.distance_m = position.distance_m;
      },
      [plane](const VolumeState& state) {
        const VolumePlane& set = state.settings.planes.at(plane);
        const bool seen = set.side != VolumePlaneSide::none || set.framed;
        return seen ? std::string()
                    : fmt::format("{} of {} is off, so this is seen after VV_CLIP {}", kVolumePlaneWords.at(plane),
                                  state.name, kVolumePlaneWords.at(plane));
      });
}

Result<std::string> VolumeService::set_table(VolumeTable table, std::string_view volume) {
  return apply(
      volume, [table](VolumeState& state) { state.settings.table = table; },
      [table](const VolumeState& state) { return table_remark(state, table); });
}

Result<std::string> VolumeService::set_medical_table(const MedicalTableParameters& parameters,
                                                     std::string_view volume) {
  return apply(
      volume, [&](VolumeState& state) { state.settings.medical = parameters; },
      [](const VolumeState& state) { return parameter_remark(state, VolumeTable::medical); });
}

Result<std::string> VolumeService::set_table_parameters(VolumeTable table, const VolumeTableParameters& parameters,
                                                        std::string_view volume) {
  return apply(
      volume, [&](VolumeState& state) { state.settings.parameters.at(std::to_underlying(table)) = parameters; },
      [table](const VolumeState& state) { return parameter_remark(state, table); });
}

Result<std::string> VolumeService::set_surface(bool on, std::optional<double> value, std::string_view volume) {
  return apply(
      volume,
      [=](VolumeState& state) {
        state.settings.isosurface = on;
        state.settings.iso_value = value.value_or(state.settings.iso_value);
      },
      [on](const VolumeState& state) -> std::string {
        if (!on || state.histogram == nullptr) return {};
        const double at = state.settings.iso_value;
        if (at > state.histogram->low && at <= state.histogram->high) return {};
        return fmt::format("the values of {} are {:g} to {:g}, so {:g} has no surface", state.name,
                           state.histogram->low, state.histogram->high, at);
      });
}

Result<std::string> VolumeService::reload_tables(std::string_view volume) {
  if (states()->empty()) return std::unexpected(no_volumes());
  if (!volume.empty()) {
    if (auto known = find_volume(cell_, volume); !known) return std::unexpected(std::move(known.error()));
  }
  if (!read_tables_) return fail("tables of users cannot be read here");
  if (auto read = take_tables(); !read) return std::unexpected(std::move(read.error()));
  ++tables_revision_;
  auto done = apply(volume, [this](VolumeState& state) {
    state.user_tables = tables_;
    state.tables_revision = tables_revision_;
  });
  const bool any = std::ranges::any_of(tables_, [](const auto& table) { return table != nullptr; });
  if (done && !any) {
    return fmt::format("the cell folder has neither {} nor {}: only the tables of the manual are there",
                       volume_table_file(0), volume_table_file(1));
  }
  return done;
}

}  // namespace cellmirror::app
