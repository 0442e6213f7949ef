// The haptic devices of the running cell: their shared memories, and their channels in the tick. Belongs to the thread
// that owns the cell.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/io/haptic_stream.hpp"
#include "app/io/metered_haptic_device.hpp"
#include "app/owner/fleet.hpp"
#include "app/snapshot/haptic_meter.hpp"
#include "app/snapshot/haptic_snapshot.hpp"
#include "config/cell_file.hpp"
#include "ipc/sysv/process_watch.hpp"
#include "ipc/sysv/shared_segment.hpp"
#include "rt_core/cell/cell.hpp"
#include "rt_core/engine/engine.hpp"
#include "rt_core/haptics/haptic_channel.hpp"

namespace cellmirror::app {

class HapticService {
 public:
  struct Parts {
    const Cell& cell;
    Fleet& fleet;
    const Clock& clock;
    std::string instance;
    std::vector<RobotHaptic> devices;  // of the cell file
    ForceGuard* guard = nullptr;       // of the memories; may be null
  };

  explicit HapticService(Parts parts);
  // Leaves zero forces in the memories; of a channel that is still open, when the engine ends.
  ~HapticService();
  HapticService(const HapticService&) = delete;
  HapticService& operator=(const HapticService&) = delete;

  // Makes the memories that the cell file names, and takes the robots online that it wants so.
  Result<void> prepare();
  // While the loop still runs: closes all channels.
  void shut_down();
  // Looks after processes that came or went, memories that were removed, and instruments that changed. Often; does
  // something every kFollowEvery.
  void follow();

  // rob_ela_shm. A robot without [[haptic]] gets the defaults. Refused: a robot with a [[stream]]; a size without room
  // for a force; more than kMaxHapticDevices; a key that others hold.
  Result<void> set_force_memory(std::string_view robot, std::int32_t key, std::size_t bytes);
  // RESET_HAPTIC. Without a fault, nothing happens. Refused: the cause is still there.
  Result<void> reset(std::string_view robot);

  // What the robot follows when it is online; null where it has no device.
  [[nodiscard]] std::shared_ptr<JointStream> stream(std::string_view robot) const;

  [[nodiscard]] bool used() const { return !devices_.empty(); }
  [[nodiscard]] bool any_online() const;
  [[nodiscard]] std::vector<HapticSnapshot> snapshots() const;

 private:
  static constexpr Nanoseconds kFollowEvery{10'000'000};
  static constexpr Nanoseconds kSameChange{1'000'000'000};  // a base that moves changes the instrument in every look

  struct Device {
    RobotHaptic config;
    std::uint8_t channel = 0;
    bool online = false;
    std::shared_ptr<SharedSegment> segment;
    std::shared_ptr<MeteredDevice> port;  // with the segment
    std::shared_ptr<HapticMeter> meter;
    std::shared_ptr<const haptics::Instrument> instrument;
    std::shared_ptr<HapticStream> stream;
    std::uint64_t revision = 0;  // of the cell for which `instrument` is right
    Timestamp exchanged;         // when the instrument was last found to have changed
    SegmentUsers users;
    ProcessWatch process;
    std::uint64_t samples_seen = 0;
    std::uint64_t faults_seen = 0;
    std::uint64_t re_engagements_seen = 0;
    bool gone = false;
  };

  Device& add(RobotHaptic config);
  Result<Device*> device_for(std::string_view robot);
  Result<HapticState> try_reset(Device& device);
  Result<void> make_memory(Device& device, std::int32_t key, std::size_t bytes);
  Result<void> open(Device& device);
  void close(Device& device);
  // The device's zero goes where the tip stands now.
  void place_at_tip(Device& device);
  Result<void> send_open(Device& device, std::shared_ptr<const haptics::Instrument> instrument);
  Result<std::shared_ptr<const haptics::Instrument>> instrument_of(const Device& device);
  void drop_memory(Device& device);
  void follow(Device& device, const HapticState& state);
  void follow_memory(Device& device);
  void follow_process(Device& device, const HapticState& state);
  void follow_cell(Device& device);
  void report_faults(Device& device, const HapticState& state);

  const Cell& cell_;
  Fleet& fleet_;
  const Clock& clock_;
  std::string instance_;
  ForceGuard* guard_;
  std::map<std::string, Device, std::less<>> devices_;
  Timestamp last_check_;
};

}  // namespace cellmirror::app
