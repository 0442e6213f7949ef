#include "drivers/can/cia402/plan.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "drivers/can/canopen/cob_id.hpp"
#include "drivers/can/canopen/eds.hpp"
#include "drivers/can/canopen/pdo.hpp"
#include "drivers/can/cia402/drive_objects.hpp"
#include "rt_core/base/capacity.hpp"

namespace cellmirror::can {
namespace {

class Planner {
 public:
  Planner(const Cia402StreamConfig& config, Diagnostics& diagnostics) : config_(&config), diagnostics_(&diagnostics) {}

  std::optional<Cia402Plan> plan() {
    const std::size_t before = diagnostics_->errors();
    Cia402Plan result;
    result.config = *config_;
    if (config_->nodes.empty()) error(config_->place, "a CiA 402 stream needs at least one node");
    if (config_->sync_period.count() < 0 || config_->heartbeat_timeout.count() < 0 ||
        config_->sdo_timeout.count() <= 0) {
      error(config_->place, "SYNC period and heartbeat timeout are not negative, the SDO timeout is positive");
    }
    for (const Cia402NodeConfig& node : config_->nodes) result.nodes.push_back(plan_node(node));
    if (diagnostics_->errors() != before) return {};
    return result;
  }

 private:
  void error(const Place& place, std::string message, std::string remedy = {}) {
    diagnostics_->error(place, std::move(message), std::move(remedy));
  }

  Cia402NodePlan plan_node(const Cia402NodeConfig& node) {
    const std::string name = fmt::format("node {} ({})", node.node_id, node.joint_name);
    Cia402NodePlan result;
    result.config = node;
    if (node.node_id < 1 || node.node_id > kMaxNodeId) {
      error(node.place, fmt::format("{}: node numbers go from 1 to {}", name, kMaxNodeId));
      return result;
    }
    if (!node_ids_.insert(node.node_id).second)
      error(node.place, fmt::format("{}: the node number appears twice", name));
    if (node.joint >= kMaxJointsPerRobot) {
      error(node.place, fmt::format("{}: joint {} is beyond {} joints", name, node.joint, kMaxJointsPerRobot));
    } else if (!joints_.insert(node.joint).second) {
      error(node.place, fmt::format("{}: the joint has two nodes", name));
    }
    check_scales(node, name);
    const std::size_t before = diagnostics_->errors();
    result.tpdos = mapping_of(result.config, name);
    const bool of_file = node.tpdos.empty() && !node.eds_file.empty();
    check_mapping(result, name, !of_file || diagnostics_->errors() == before);
    return result;
  }

  void check_scales(const Cia402NodeConfig& node, const std::string& name) {
    if (!std::isfinite(node.scale) || node.scale <= 0)
      error(node.place, fmt::format("{}: the scale has to be positive", name));
    if (node.sign != 1.0 && node.sign != -1.0) error(node.place, fmt::format("{}: the sign is 1 or -1", name));
    if (!std::isfinite(node.offset) || !std::isfinite(node.velocity_scale) || !std::isfinite(node.torque_scale)) {
      error(node.place, fmt::format("{}: offset and scales have to be finite", name));
    }
  }

  // Takes the position range from the EDS if the cell file does not set it.
  static void take_range(const ObjectDictionary& objects, Cia402NodeConfig& node) {
    const auto lower = objects.integer({0x607B, 1});
    const auto upper = objects.integer({0x607B, 2});
    if (!node.turns || node.range_lower < node.range_upper || !lower || !upper || *lower >= *upper) return;
    node.range_lower = *lower;
    node.range_upper = *upper;
  }

  std::vector<TpdoConfig> mapping_of(Cia402NodeConfig& node, const std::string& name) {
    if (!node.tpdos.empty()) {
      std::vector<TpdoConfig> tpdos = node.tpdos;
      for (TpdoConfig& tpdo : tpdos) fill_cob_id(tpdo, node, name);
      if (node.turns && !node.eds_file.empty()) {
        Diagnostics ignored;  // the cell file has the mapping, so faults of the EDS do not matter
        if (const auto device = read_eds(node.eds_file, node.node_id, ignored)) take_range(device->objects, node);
      }
      return tpdos;
    }
    if (!node.eds_file.empty()) {
      const auto device = read_eds(node.eds_file, node.node_id, *diagnostics_);
      if (!device) return {};
      std::vector<TpdoConfig> tpdos = tpdos_of(*device, node.node_id, node.eds_file, *diagnostics_);
      take_range(device->objects, node);
      warn_of_foreign_node(*device, tpdos, node.node_id, node.eds_file, *diagnostics_);
      return tpdos;
    }
    TpdoConfig tpdo;
    tpdo.transmission_type = config_->sync_period.count() > 0 ? 1 : 255;
    tpdo.entries = {{kStatusword.index, 0, 16}, {kPositionActual.index, 0, 32}};
    fill_cob_id(tpdo, node, name);
    return {tpdo};
  }

  void fill_cob_id(TpdoConfig& tpdo, const Cia402NodeConfig& node, const std::string& name) {
    if (tpdo.cob_id != 0) return;
    if (tpdo.number >= 1 && tpdo.number <= 4) {
      tpdo.cob_id = tpdo_cob_id(tpdo.number, node.node_id);
    } else {
      error(node.place, fmt::format("{}: TPDO{} needs a COB-ID of its own; only TPDO1 to TPDO4 have a predefined one",
                                    name, tpdo.number));
    }
  }

  // `known`: the mapping was read without an error; otherwise a missing position is a consequence of a reported error.
  void check_mapping(const Cia402NodePlan& node, const std::string& name, bool known) {
    bool has_position = false;
    for (const TpdoConfig& tpdo : node.tpdos) {
      if (!is_valid_mapping(tpdo.entries)) {
        error(node.config.place,
              fmt::format("{}: the mapping of TPDO{} is empty or beyond 64 bits", name, tpdo.number));
      }
      const std::uint32_t id = tpdo.cob_id & (kCobIdExtended | 0x1FFF'FFFF);
      const bool fits = (id & kCobIdExtended) != 0 || id < 0x800;
      if (!fits) error(node.config.place, fmt::format("{}: 0x{:X} is no COB-ID of 11 bits", name, tpdo.cob_id));
      if (!cob_ids_.insert(id).second)
        error(node.config.place, fmt::format("{}: the COB-ID 0x{:X} appears twice", name, id));
      has_position |= find_in_mapping(tpdo.entries, kPositionActual.index, kPositionActual.subindex).has_value();
    }
    if (!has_position && known) {
      const std::string of = node.config.eds_file.empty() ? "" : " of " + node.config.eds_file;
      error(
          node.config.place, fmt::format("{}: no TPDO{} holds the position actual value 0x6064", name, of),
          "write the mapping into the cell file as [[stream.node.tpdo]], with configure = true if the drive lacks it");
    }
  }

  const Cia402StreamConfig* config_;
  Diagnostics* diagnostics_;
  std::set<std::uint8_t> node_ids_;
  std::set<std::size_t> joints_;
  std::set<std::uint32_t> cob_ids_;
};

}  // namespace

std::optional<Cia402Plan> plan_cia402(const Cia402StreamConfig& config, Diagnostics& diagnostics) {
  return Planner(config, diagnostics).plan();
}

}  // namespace cellmirror::can
