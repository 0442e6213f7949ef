// The thread that looks at what the gateway publishes and gives it to the recordings: robot states at the wanted rate,
// the workers' results when there are new ones. It looks from outside: the tick does nothing for it.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "app/io/can_tap.hpp"
#include "app/io/payload_tap.hpp"
#include "app/recorder/alarm_recorder.hpp"
#include "app/recorder/input_recorder.hpp"
#include "app/recorder/output_messages.hpp"
#include "app/recorder/picture_recorder.hpp"
#include "app/recorder/recording_hub.hpp"
#include "app/recorder/tissue_recorder.hpp"
#include "app/snapshot/board.hpp"
#include "app/snapshot/cell_state.hpp"
#include "app/snapshot/command_record.hpp"
#include "app/snapshot/proximity_board.hpp"
#include "app/snapshot/range_readings.hpp"
#include "app/snapshot/robot_states.hpp"
#include "drivers/dds/range_message.hpp"
#include "drivers/dds/robot_state_messages.hpp"
#include "drivers/dds/wrench_message.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/engine/tick_reader.hpp"
#include "rt_core/ports/force_state.hpp"

namespace cellmirror::app {

class Recorder {
 public:
  // All outlive the recorder.
  struct Sources {
    engine::TickReader& ticks;
    const Board<CellState>& board;
    const ProximityBoard& proximity;
    const Board<RangeReadings>& ranges;
    const Board<ForceState>& forces;
    const Clock& clock;
    Nanoseconds tick_period{0};
    std::function<std::string()> status;        // the document
    CanTap* can_tap = nullptr;                  // null: frames are not recorded
    PayloadTap* payload_tap = nullptr;          // null: what DDS and RTDE streams receive is not recorded
    engine::InputTap* engine_inputs = nullptr;  // null: the inputs of the tick are not recorded
    PictureRecorder::Open open_pictures = {};   // empty: no pictures are recorded
    AlarmLines alarms = {};                     // empty: no alarms are recorded
    TissueSources tissue = {};                  // empty: the cell has no deformable objects
    bool keeps_collisions = false;              // the ring is kept where bodies touch
  };

  Recorder(Sources sources, RecordingHub& hub);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

 private:
  void loop(const std::stop_token& stop);
  void look(const engine::TickState& state, double rate_hz);
  void record_tick(const engine::TickState& state, const CellState& cell_state, const ForceState* forces);
  void switch_taps(bool on) const;
  void record_inputs();
  void record_frames_of_can();
  void record_payloads();
  void record_joints(std::int64_t wall_ns, const CellState& cell_state, std::span<const RobotState> robots);
  void record_frames(std::int64_t wall_ns, const CellState& cell_state);
  void record_proximity();
  void record_ranges();
  void record_forces(const ForceState& state);
  void record_switches(std::int64_t wall_ns, const FootSwitchSnapshot& switches);
  void record_status(Timestamp now);
  const TopicPtr& joint_topic(const CellState& cell_state, std::span<const RobotState> robots);
  void put_text(const TopicPtr& topic, std::int64_t wall_ns, const std::string& text) {
    hub_.put(topic, wall_ns, mcap::view_of(text));
  }

  Sources sources_;
  RecordingHub& hub_;
  TopicPtr tf_ = OutputTopics::tf();
  TopicPtr collisions_ = OutputTopics::collisions();
  TopicPtr events_ = OutputTopics::collision_events();
  TopicPtr forces_ = OutputTopics::forces();
  TopicPtr status_ = OutputTopics::status();
  TopicPtr switches_ = OutputTopics::foot_switches();
  std::optional<std::uint64_t> newest_edge_;
  std::vector<std::uint32_t> inputs_on_;
  TopicPtr joints_;
  mcap::Texts joint_names_;                         // of joints_
  std::shared_ptr<const CompiledCell> joint_cell_;  // likewise
  std::map<std::string, TopicPtr, std::less<>> range_topics_;
  std::map<std::string, TopicPtr, std::less<>> wrench_topics_;
  std::map<std::string, TopicPtr, std::less<>> can_topics_;
  std::map<std::pair<PayloadKind, std::string>, TopicPtr> payload_topics_;

  RobotStateBuilder builder_;
  std::vector<RobotState> robots_;
  dds::JointNames names_;
  dds::JointState joint_state_;
  dds::TfMessage transforms_;
  dds::Range range_;
  dds::WrenchStamped wrench_;
  std::vector<std::byte> bytes_;
  std::vector<bool> all_;
  std::uint64_t last_tick_ = 0;
  std::uint64_t newest_proximity_ = 0;
  std::uint64_t newest_event_ = 0;
  std::uint64_t newest_ranges_ = 0;
  std::uint64_t newest_forces_ = 0;
  Timestamp last_frames_;
  Timestamp last_findings_;
  Timestamp last_status_;
  PictureRecorder pictures_;
  AlarmRecorder alarms_;
  TissueRecorder tissue_;
  std::unique_ptr<InputRecorder> inputs_;  // null: none are recorded
  std::jthread thread_;                    // last: it uses everything above
};

// Gives lines of the log, commands with their acknowledgements, and changes of foot switches to the recordings. Any
// thread but the tick's.
class RecordedTexts {
 public:
  RecordedTexts(RecordingHub& hub, const Clock& clock) : hub_(hub), clock_(clock) {}
  void log(LogLevel level, std::string_view kind, std::string_view text);
  void command(const CommandRecord& record);
  void switch_changed(const FootSwitchChange& change);

 private:
  RecordingHub& hub_;
  const Clock& clock_;
  TopicPtr log_ = OutputTopics::log();
  TopicPtr commands_ = OutputTopics::commands();
  TopicPtr switch_changes_ = OutputTopics::foot_switch_changes();
};

}  // namespace cellmirror::app
