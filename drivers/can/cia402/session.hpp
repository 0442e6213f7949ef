// The mirror's role on a bus of CiA 402 drives: starts and watches the nodes of one robot, produces SYNC where
// configured, and makes joint samples of their TPDOs. Protocol only, without I/O and without a clock: frames and time
// are pushed in, frames, samples and events come out.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/can/alternation_watch.hpp"
#include "drivers/can/canopen/emcy.hpp"
#include "drivers/can/canopen/heartbeat_cadence.hpp"
#include "drivers/can/canopen/nmt.hpp"
#include "drivers/can/canopen/pdo.hpp"
#include "drivers/can/canopen/sdo_client.hpp"
#include "drivers/can/cia402/plan.hpp"
#include "drivers/can/cia402/state.hpp"
#include "drivers/can/timed_values.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/can_channel.hpp"
#include "rt_core/ports/joint_stream.hpp"

namespace cellmirror::can {

enum class Cia402EventKind : std::uint8_t {
  boot_up,
  node_lost,      // no heartbeat in time
  node_resolved,  // the heartbeat is back
  emcy,
  configured,
  configuration_failed,
  tpdo_missing,  // a node did not answer a SYNC
  rejected,      // a frame of one of our nodes that makes no sense
  second_drive,  // another drive has the id of a node
};

struct Cia402Event {
  Cia402EventKind kind = Cia402EventKind::boot_up;
  std::size_t node = 0;  // number in the configuration
  std::string text;      // "node 3 (J_2): ..."
};

class Cia402SessionOutput {
 public:
  virtual ~Cia402SessionOutput() = default;
  // False where the frame could not be sent.
  virtual bool send(const CanFrame& frame) = 0;
  virtual void sample(const JointSample& sample) = 0;
  virtual void event(const Cia402Event& event) = 0;
};

struct Cia402Counters {
  std::uint64_t samples = 0;
  std::uint64_t lost = 0;          // TPDOs that a SYNC should have brought
  std::uint64_t rejected = 0;      // frames of our nodes that make no sense
  std::uint64_t syncs = 0;         // sent and, where another node produces them, seen
  std::uint64_t syncs_missed = 0;  // periods in which this session was called too late, or the bus refused the SYNC
};

// What is known of a node.
struct Cia402NodeStatus {
  std::uint8_t node_id = 0;
  std::string joint_name;
  bool heard = false;           // any frame of it
  std::optional<NmtState> nmt;  // none: unknown or lost
  bool heartbeat_lost = false;
  Timestamp last_heartbeat;  // never: none yet
  bool configuring = false;
  std::string configuration_error;  // empty: none
  Cia402State state = Cia402State::unknown;
  std::uint16_t statusword = 0;
  std::optional<Emcy> last_emcy;
  std::uint64_t boot_ups = 0;
  bool doubled_heartbeats = false;  // they come as if two drives sent them
  std::uint64_t conflicts = 0;      // positions that two drives gave
  bool in_conflict = false;         // the newest position was one of two drives'
  Timestamp last_conflict;
  AlternationWatch::Places places;  // of the two, rad or m
  Timestamp last_tpdo;
};

class Cia402Session {
 public:
  // A node that is lost is asked by SDO after this time and again this often. docs/can.md, "Watching".
  static constexpr Nanoseconds kAskLost{1'000'000'000};

  // `output` outlives the session; `plan` comes from plan_cia402().
  Cia402Session(Cia402Plan plan, Cia402SessionOutput& output);

  // Once, before anything else: configures and starts the nodes, sets the phase of SYNC.
  void start(Timestamp now);
  // Any frame of the bus. `now`: when it was received.
  void receive(const CanFrame& frame, Timestamp now);
  // What is due: SYNC, timeouts, retries. Call at next_due() or more often.
  void advance(Timestamp now);
  [[nodiscard]] Timestamp next_due() const;  // never: nothing is timed

  [[nodiscard]] const Cia402Counters& counters() const { return counters_; }
  [[nodiscard]] std::vector<Cia402NodeStatus> nodes() const;
  // The same into memory that is used again: allocates only where a text has grown.
  void copy_nodes(std::vector<Cia402NodeStatus>& out) const;

 private:
  struct ConfigurationStep {
    ObjectAddress address;
    std::uint32_t value = 0;
    std::uint8_t bytes = 0;
    bool optional = false;  // a device may lack the object
  };
  struct Quantity {
    std::size_t first_bit = 0;
    std::uint8_t bits = 0;  // 0: not mapped
  };
  struct Tpdo {
    std::size_t node = 0;
    std::uint32_t cob_id = 0;
    bool extended = false;
    std::uint8_t number = 0;
    std::uint8_t length = 0;
    bool synchronous = false;
    unsigned every = 1;  // SYNCs; 0: only where something changed (transmission type 0), so never waited for
    Quantity statusword, position, velocity, torque;
    unsigned syncs = 0;     // since it last came
    bool expected = false;  // in the cycle under way
  };
  struct Node {
    Cia402NodePlan plan;
    Cia402NodeStatus status;
    AlternationWatch senders = {};
    HeartbeatCadence cadence = {};
    bool was_operational = false;  // by its newest heartbeat
    bool answering = false;        // its synchronous TPDOs came since it was started: one that stays out is a loss
    // For continuous joints: the newest 0x6064, and the position without wraps, both in increments.
    std::optional<std::int64_t> counter;
    std::int64_t turned = 0;
    Timestamp heartbeat_deadline;
    Timestamp start_sent;
    std::optional<SdoClient> sdo;
    std::vector<ConfigurationStep> steps;
    std::size_t step = 0;
    bool configured = false;
    Timestamp retry;      // of a configuration that failed
    Timestamp ask;        // when a lost node is asked next; never: it is not lost, or is not asked
    bool asking = false;  // `sdo` reads, and nodes that are configured: what `step` has written
  };

  // session.cpp
  void on_tpdo(Tpdo& tpdo, const CanFrame& frame, Timestamp now);
  void decode(const Tpdo& tpdo, const CanFrame& frame);
  void take_position(std::size_t index, double position);
  // The position in increments; for continuous joints, it continues where the counter wraps.
  [[nodiscard]] static double unwrapped(Node& node, std::int64_t counter, std::uint8_t bits);
  void on_sync(Timestamp now);
  void count_missing();
  [[nodiscard]] bool cycle_is_complete() const;
  void emit();
  void produce_sync(Timestamp now);
  void reject(std::size_t node, std::string why);
  void report(Cia402EventKind kind, std::size_t node, std::string what);
  // session_nodes.cpp
  void on_heartbeat(std::size_t index, NmtState state, Timestamp now);
  void on_boot_up(std::size_t index, Timestamp now);
  void on_emcy(std::size_t index, const Emcy& emcy);
  void bring_up(std::size_t index, Timestamp now);
  void start_node(Node& node, Timestamp now);
  void begin_configuration(std::size_t index, Timestamp now);
  void next_step(std::size_t index, Timestamp now);
  void on_sdo_progress(std::size_t index, Timestamp now);
  void fail_configuration(std::size_t index, const std::string& why, Timestamp now);
  void watch(std::size_t index, Timestamp now);
  // session_lost_nodes.cpp
  [[nodiscard]] bool asks_lost_nodes(const Node& node) const;
  void ask(std::size_t index, Timestamp now);
  void ask_for_step(std::size_t index, Timestamp now);
  void on_asked(std::size_t index, Timestamp now);
  void on_forgotten(std::size_t index, Timestamp now);
  [[nodiscard]] bool is_silent(const Node& node, Timestamp now) const;
  [[nodiscard]] static bool is_last_write(const Node& node, std::size_t step);
  [[nodiscard]] static bool kept(const Node& node);
  [[nodiscard]] static std::vector<ConfigurationStep> steps_of(const Cia402Plan& plan, const Cia402NodePlan& node);

  Cia402Plan plan_;
  Cia402SessionOutput* output_;
  std::vector<Node> nodes_;
  std::vector<Tpdo> tpdos_;
  // Index + 1 into tpdos_ by 11-bit identifier, and into nodes_ by node number; 0: none of ours.
  std::array<std::uint16_t, 0x800> tpdo_of_id_{};
  std::array<std::uint8_t, 128> node_of_id_{};
  bool has_extended_ = false;
  JointSample sample_;  // newest values; `present` collects the cycle under way
  TimedValues velocity_;
  TimedValues effort_;
  bool in_cycle_ = false;
  Timestamp cycle_start_;
  Timestamp next_sync_;
  Cia402Counters counters_;
};

// "two drives answer: near 0.1 and 0.7 rad or m".
[[nodiscard]] std::string conflict_text(const Cia402NodeStatus& node);
// One line: "operational", or what is wrong, at most three nodes of it: "node 3 (J_2): no heartbeat since 1.2 s".
[[nodiscard]] std::string condition(const std::vector<Cia402NodeStatus>& nodes, Timestamp now);
// "operational, operation enabled"; for status().
[[nodiscard]] std::string words(const Cia402NodeStatus& node, Timestamp now);

}  // namespace cellmirror::can
