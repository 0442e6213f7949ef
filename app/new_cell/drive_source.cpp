#include "app/new_cell/drive_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <optional>
#include <set>
#include <system_error>

#include "app/new_cell/names.hpp"
#include "drivers/can/canopen/eds.hpp"

namespace cellmirror::app {

namespace fs = std::filesystem;

namespace {

constexpr std::uint16_t kPositionActual = 0x6064;
constexpr double kTurn = 2.0 * std::numbers::pi;
// Where the EDS says nothing: 16 bits a turn, and micrometres.
constexpr double kUsualIncrementsPerTurn = 65536.0;
constexpr double kUsualIncrementsPerM = 1e6;

// A ratio of two entries of an object, as CiA 402 defines 0x608F and 0x6091; none where it is not a number above 0.
std::optional<double> ratio(const can::ObjectDictionary& objects, std::uint16_t index) {
  const auto above = objects.integer({index, 1});
  const auto below = objects.integer({index, 2});
  if (!above || !below || *above <= 0 || *below <= 0) return std::nullopt;
  return static_cast<double>(*above) / static_cast<double>(*below);
}

// Increments of the encoder for a turn of the joint: encoder resolution (0x608F) times gear ratio (0x6091). One
// increment a turn is what an EDS says that says nothing.
std::optional<double> increments_per_turn(const can::ObjectDictionary& objects) {
  const auto resolution = ratio(objects, 0x608F);
  if (!resolution || *resolution <= 1.0) return std::nullopt;
  return *resolution * ratio(objects, 0x6091).value_or(1.0);
}

bool holds_position(const TpdoConfig& tpdo) {
  return std::ranges::any_of(tpdo.entries, [](const PdoEntryConfig& entry) { return entry.index == kPositionActual; });
}

// TPDO1 = statusword and position: what simulated drives send.
bool is_default(const TpdoConfig& tpdo) {
  return tpdo.number == 1 && tpdo.entries.size() == 2 && tpdo.entries[0].index == 0x6041 &&
         tpdo.entries[0].bits == 16 && tpdo.entries[1].index == kPositionActual && tpdo.entries[1].bits == 32;
}

// Returns true if the device is a drive; otherwise reports the kind of the device.
bool is_drive(const can::DeviceDescription& device, const std::string& file, Diagnostics& diagnostics) {
  if (can::is_drive(device)) return true;
  const auto type = device.objects.integer({0x1000, 0});
  constexpr std::int64_t kIoProfile = 401;
  const std::int64_t profile = type.value_or(0) & 0xFFFF;
  const std::string kind = profile == kIoProfile ? "an I/O device (CiA 401)"
                           : profile != 0        ? fmt::format("a device of profile {}", profile)
                                                 : "a device without a profile";
  diagnostics.error({file, 0, 0},
                    fmt::format("the file describes {}, not a drive: it has no position actual value 0x6064", kind),
                    profile == kIoProfile ? "give the EDS of a drive (CiA 402); I/O of the cell is an [[io_node]]"
                                          : "give the EDS of a drive (CiA 402)");
  return false;
}

// Notes what the TPDOs of the file hold. An identifier that another node has already makes them useless.
void note_mapping(const can::DeviceDescription& device, const std::string& file, std::set<std::uint32_t>& cob_ids,
                  PlannedDrive& drive, Diagnostics& diagnostics) {
  const std::vector<TpdoConfig> tpdos = can::tpdos_of(device, drive.node, file, diagnostics);
  const bool free = std::ranges::none_of(tpdos, [&](const TpdoConfig& tpdo) { return cob_ids.contains(tpdo.cob_id); });
  drive.position_mapped = free && std::ranges::any_of(tpdos, holds_position);
  drive.default_mapping = !drive.position_mapped || std::ranges::any_of(tpdos, is_default);
  if (!drive.position_mapped) return;
  for (const TpdoConfig& tpdo : tpdos) cob_ids.insert(tpdo.cob_id);
}

}  // namespace

std::string add_description(const fs::path& source, std::vector<PlannedFile>& files) {
  std::error_code error;
  const fs::path from = fs::canonical(source, error);
  const std::string plain = plain_file_name(source.filename().string());
  const fs::path stem = fs::path(plain).stem();
  const fs::path extension = fs::path(plain).extension();
  for (int i = 1;; ++i) {
    const std::string name = i == 1 ? plain : fmt::format("{}_{}{}", stem.string(), i, extension.string());
    const auto same = std::ranges::find(files, "robots/" + name, &PlannedFile::to);
    if (same != files.end() && same->from != from) continue;
    if (same == files.end()) files.push_back({from, "robots/" + name, {}});
    return name;
  }
}

std::vector<PlannedDrive> read_drive_sources(const NewCellRequest& request, const PlannedRobot& robot,
                                             std::vector<PlannedFile>& files, Diagnostics& diagnostics) {
  std::vector<PlannedDrive> drives;
  std::set<std::uint32_t> cob_ids;
  for (std::size_t i = 0; i < request.nodes.size() && i < robot.joints.size(); ++i) {
    const bool linear = robot.joints[i].kind == JointKind::prismatic;
    PlannedDrive drive;
    drive.node = request.nodes[i];
    drive.joint = i;
    drive.increments = linear ? kUsualIncrementsPerM : kUsualIncrementsPerTurn / kTurn;
    drive.default_mapping = true;
    if (!request.eds.empty()) {
      const fs::path& source = request.eds.size() == 1 ? request.eds.front() : request.eds[i];
      const auto device = can::read_eds(source.string(), drive.node, diagnostics);
      if (!device || !is_drive(*device, source.string(), diagnostics)) return {};
      drive.eds = add_description(source, files);
      note_mapping(*device, source.string(), cob_ids, drive, diagnostics);
      const auto per_turn = linear ? std::nullopt : increments_per_turn(device->objects);
      if (per_turn) drive.increments = *per_turn / kTurn;
      drive.increments_known = per_turn.has_value();
    }
    drives.push_back(std::move(drive));
  }
  return drives;
}

}  // namespace cellmirror::app
