// The robots of the running cell: where the model, the tick and the streams of the real robots meet.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/io/turn_unwrapper.hpp"
#include "app/owner/motion/motion_port.hpp"
#include "app/snapshot/contact_inlet.hpp"
#include "app/snapshot/fault_target.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/cell/cell.hpp"
#include "rt_core/engine/engine.hpp"
#include "rt_core/ports/joint_stream.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::app {

class CanTap;
class NodeChannels;
class PayloadTap;

// One robot of the fleet, beside its RobotModel in the cell.
struct FleetRobot {
  std::string id;
  std::size_t slot = 0;
  bool online = false;
  bool sending = false;
  // rad or m: where a command to the tick puts it, and the id of that command.
  JointValues put_at{};
  std::uint64_t put_command = 0;
  JointValues start{};                          // where it was put when it was added, rad or m
  bool commanded = false;                       // it has been moved, set to a position, or online since it was added
  std::shared_ptr<TurnUnwrapper> turns = {};    // sink of the open stream; null: no continuous joint
  std::shared_ptr<JointStream> stream;          // null until the first `online`; status() is asked from other threads
  std::shared_ptr<ContactInlet> contacts = {};  // of drives that answer a controller; null: the robot has none
  std::shared_ptr<const FaultTarget> faults = {};  // likewise
};

// Belongs to the thread that owns the cell. Keeps the tick's slots equal to the robots of the cell.
class Fleet final : public MotionPort {
 public:
  struct Events {
    // Off line: a call that waits for the tick runs one with this, and streams are refused. Empty: the tick has its
    // own thread.
    std::function<void()> let_tick_pass = {};
    // With every move that is given to the tick.
    std::function<void(std::string_view robot, const motion::Move& move)> move_given = {};
    // What a robot without a stream in the cell file follows when it goes online; null: it has nothing of the kind.
    std::function<std::shared_ptr<JointStream>(std::string_view robot)> device_stream = {};
    CanTap* can_tap = nullptr;  // sees the frames of CAN streams; outlives the fleet; null: nobody does
    const NodeChannels* node_channels = nullptr;  // of drives that answer; outlives the fleet; null: there are none
    PayloadTap* payload_tap = nullptr;            // what DDS and RTDE streams receive; likewise
  };
  // Before the first tick, since it subscribes to the engine. `stream_priority`: SCHED_FIFO priority of the streams'
  // threads; 0: none.
  Fleet(Cell& cell, engine::Engine& engine, std::map<std::string, StreamConfig, std::less<>> streams,
        const Clock& clock, int stream_priority, Events events);
  Fleet(Cell& cell, engine::Engine& engine, std::map<std::string, StreamConfig, std::less<>> streams,
        const Clock& clock, int stream_priority)
      : Fleet(cell, engine, std::move(streams), clock, stream_priority, Events()) {}
  // Closes all streams.
  ~Fleet() override;
  Fleet(const Fleet&) = delete;
  Fleet& operator=(const Fleet&) = delete;

  // Adds robots that came with a component to the tick, and removes those that were deleted. After every change of the
  // tree.
  Result<void> follow_cell();
  // Tells the tick the robot's present limits.
  Result<void> update_limits(const RobotModel& robot);

  [[nodiscard]] const FleetRobot* find(std::string_view id) const;
  // Whether positions() tells where the robot really is: of a mirrored one only while its values are fresh.
  [[nodiscard]] bool knows_position(std::string_view id);
  [[nodiscard]] const std::map<std::string, FleetRobot, std::less<>>& robots() const { return robots_; }

  Result<void> set_online(std::string_view id, bool online);
  Result<void> set_sending(std::string_view id, bool sending);
  // Puts the robot to `start` while it stands where it was added, since nothing has moved it yet. False: it does not.
  Result<bool> begin_at(std::string_view id, const JointValues& start);

  Result<void> check_simulated(std::string_view id) const override;
  [[nodiscard]] motion::MotionState motion(std::string_view id) override;
  // As the tick published them last; a jump that it has not carried out yet counts as done.
  [[nodiscard]] std::span<const JointValues> positions() override;
  Result<void> jump(std::string_view id, const JointValues& positions) override;
  Result<void> set_chain(std::string_view id, std::shared_ptr<const kinematics::Chain> chain) override;
  Result<void> add_move(std::string_view id, const motion::Move& move) override;
  Result<void> stop_motion(std::string_view id) override;
  Result<void> set_pace(std::string_view id, double pace) override;
  Result<void> hold_behind(std::string_view id, std::uint32_t move) override;

  // Of a robot that is known. The id of the command.
  Result<std::uint64_t> follow_trajectory(std::string_view id, std::shared_ptr<const motion::Trajectory> trajectory);

  [[nodiscard]] bool has_stream(std::string_view id) const { return streams_.find(id) != streams_.end(); }

  // The newest state that the tick published; valid until the next call of any function of the fleet.
  [[nodiscard]] const engine::TickState& tick() { return ticks_.newest(); }
  // Waits while the tick's queue is full. Its id.
  Result<std::uint64_t> send(engine::Command command);
  // For a command: Engine::lend().
  template <class T>
  [[nodiscard]] Lease<T> lend(std::shared_ptr<T> object) {
    return engine_.lend(std::move(object));
  }
  // Waits until the tick has carried out everything that was sent so far, and frees what it gave back.
  Result<void> settle();

 private:
  Result<void> put(FleetRobot& robot, const JointValues& positions);
  // A moment, for the tick to take commands.
  void wait_for_tick() const;
  Result<void> add(const RobotModel& robot);
  Result<void> bring_online(FleetRobot& robot);
  // The stream of the cell file, else that of the robot's device.
  Result<void> make_stream(FleetRobot& robot);
  Result<void> take_offline(FleetRobot& robot);
  // Returns the sink for the samples of its stream; makes a TurnUnwrapper if the robot has continuous joints.
  [[nodiscard]] JointSampleSink& sink_of(FleetRobot& robot);
  [[nodiscard]] std::uint8_t slot_of(std::string_view id) const;

  Cell& cell_;
  engine::Engine& engine_;
  engine::TickReader& ticks_;
  std::map<std::string, StreamConfig, std::less<>> streams_;
  const Clock& clock_;
  int stream_priority_;
  Events events_;
  std::map<std::string, FleetRobot, std::less<>> robots_;
  std::vector<JointValues> positions_;
  std::uint64_t last_command_ = 0;
};

}  // namespace cellmirror::app
