// Joint samples from frames that a DBC describes. Protocol only, without I/O and without a clock.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "drivers/can/alternation_watch.hpp"
#include "drivers/can/dbc/dbc.hpp"
#include "drivers/can/e2e/e2e.hpp"
#include "drivers/can/timed_values.hpp"
#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/can_channel.hpp"
#include "rt_core/ports/joint_stream.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::can {

struct DbcPlan {
  struct Mapped {
    std::size_t message = 0;  // in dbc.messages
    std::size_t signal = 0;   // in its signals
    DbcSignalConfig config;
  };
  DbcStreamConfig config;
  Dbc dbc;
  struct Protection {
    std::size_t message = 0;
    E2eFormat format;
  };
  std::vector<Mapped> mapped;
  std::vector<Protection> protections;
};

// Reads the DBC and finds the configured signals in it; unknown names are answered with the nearest ones. All errors
// are reported; no plan where there was one. Warns of signals in a unit that is not SI where the cell file gives no
// scale.
[[nodiscard]] std::optional<DbcPlan> plan_dbc(const DbcStreamConfig& config, Diagnostics& diagnostics);
// The same with a DBC that was read already.
[[nodiscard]] std::optional<DbcPlan> plan_dbc(const DbcStreamConfig& config, Dbc dbc, Diagnostics& diagnostics);

class DbcSessionOutput {
 public:
  virtual ~DbcSessionOutput() = default;
  virtual void sample(const JointSample& sample) = 0;
  // A frame or a value was refused: "Joint_3: 4 bytes, the DBC says 8".
  virtual void rejected(const std::string& why) = 0;
  // A signal left the limits that the DBC gives it, and was taken all the same: "Joint_3.Angle is 200 deg, ...". Not
  // again before it was within them, nor within 10 s.
  virtual void outside(const std::string& what) = 0;
};

struct DbcCounters {
  std::uint64_t samples = 0;
  std::uint64_t rejected = 0;
  std::uint64_t outside = 0;  // values beyond the DBC's limits, which were taken
  // By the counters and CRCs of protected messages.
  std::uint64_t lost = 0;
  std::uint64_t repeated = 0;
  std::uint64_t wrong_sequence = 0;
  std::uint64_t wrong_crc = 0;
  std::uint64_t conflicts = 0;  // values of two senders

  [[nodiscard]] std::uint64_t protection_errors() const { return repeated + wrong_sequence + wrong_crc; }
};

// The newest of each kind; the session owns what it points to. Times are "never" where there was none.
struct DbcTrouble {
  E2eStatus status = E2eStatus::ok;
  const DbcMessage* message = nullptr;
  Timestamp protection;
  const DbcMessage* conflict_message = nullptr;
  const DbcSignal* conflict_signal = nullptr;
  AlternationWatch::Places places;
  Timestamp conflict;
};

class DbcSession {
 public:
  // `output` outlives the session.
  DbcSession(DbcPlan plan, DbcSessionOutput& output);
  DbcSession(const DbcSession&) = delete;  // points into its own plan
  DbcSession& operator=(const DbcSession&) = delete;

  // The source has restarted: discards its values, the counters of protected messages, and the senders seen so far.
  void restart();

  // Any frame of the bus. One with position signals makes a sample; velocities and efforts of other frames go with it
  // unless they are lost or were refused. Of a protected message nothing is taken whose counter or CRC is wrong: its
  // joints are refused; a repeated one makes no sample. What two senders give is in conflict. Frames shorter than the
  // DBC says are refused, longer ones (FD padding) are taken.
  void receive(const CanFrame& frame, Timestamp now);

  [[nodiscard]] const DbcCounters& counters() const { return counters_; }
  [[nodiscard]] const DbcTrouble& trouble() const { return trouble_; }

 private:
  struct Field {
    const DbcSignal* signal = nullptr;
    std::size_t joint = 0;
    JointQuantity quantity = JointQuantity::position;
    double scale = 1.0;
    double offset = 0.0;
    bool outside = false;  // and that was reported
    Timestamp told;
    AlternationWatch senders = {};  // of positions
    // For continuous joints: range of the counter (0: does not wrap) and newest value without wraps, both in rad.
    double span = 0;
    std::optional<double> last = {};
    double last_sent = 0;  // the newest value as the source sent it; valid if `last` is set
  };
  struct Source {
    const DbcMessage* message = nullptr;
    std::vector<Field> fields;
    std::optional<E2eChecker> checker;
  };

  // Whether the frame may be used.
  bool is_sound(Source& source, const CanFrame& frame, Timestamp now);
  void refuse_fields(const Source& source);
  void emit(Timestamp now);
  void take_position(const Source& source, Field& field, double value, Timestamp now);
  void take(const Source& source, Field& field, const CanFrame& frame, Timestamp now);
  void watch_limits(const Source& source, Field& field, double physical, Timestamp now);
  void reject(const std::string& why);

  DbcPlan plan_;
  DbcSessionOutput* output_;
  std::map<std::pair<bool, std::uint32_t>, Source> sources_;  // by extended, identifier
  JointSample sample_;
  TimedValues velocity_;
  TimedValues effort_;
  DbcCounters counters_;
  DbcTrouble trouble_;
};

}  // namespace cellmirror::can
