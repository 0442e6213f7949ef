// One haptic device and its instrument inside the tick: reads the device, moves the instrument, answers with a force.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "rt_core/base/real_time.hpp"
#include "rt_core/haptics/contact_model.hpp"
#include "rt_core/haptics/force_gate.hpp"
#include "rt_core/haptics/instrument.hpp"
#include "rt_core/haptics/instrument_map.hpp"
#include "rt_core/haptics/model_watch.hpp"
#include "rt_core/haptics/passivity.hpp"
#include "rt_core/haptics/proxy.hpp"
#include "rt_core/haptics/re_engagement.hpp"
#include "rt_core/haptics/sample_validator.hpp"
#include "rt_core/haptics/tip_solver.hpp"
#include "rt_core/haptics/tissue_coupling.hpp"
#include "rt_core/haptics/tissue_force.hpp"
#include "rt_core/haptics/virtual_coupling.hpp"
#include "rt_core/ports/haptic_device.hpp"
#include "rt_core/ports/haptic_state.hpp"
#include "rt_core/ports/joint_stream.hpp"

namespace cellmirror::haptics {

struct TickInput {
  Timestamp now;
  Nanoseconds period{};
  std::uint64_t missed = 0;             // periods just before this tick
  const ContactModel* model = nullptr;  // newest; null: none yet, and until one is there the device does not engage
  std::span<const double> q;            // rad or m, positions of all joints
  bool device_gone = false;             // the device's process is known to have ended
  const TissueForce* tissue = nullptr;  // newest; null: none yet, or the cell has no tissue
};

// How long a device has to behave before a fault may be taken back.
inline constexpr Nanoseconds kQuietBeforeReset{20'000'000};

// All memory is inside; everything but the construction belongs to the tick.
class HapticChannel {
 public:
  // `instrument` and `port` outlive the time until close() has been carried out. Phase `waiting`.
  void open(const Instrument& instrument, HapticDevicePort& port) CELL_RT;
  // Writes a last output of zero force.
  void close() CELL_RT;
  // Another instrument for the open device, which engages again: no force until its surroundings are known. A latched
  // fault stays, and so does the clutch offset if the device's base is unchanged. `instrument` as in open(); the
  // previous one is no longer accessed.
  void exchange(const Instrument& instrument) CELL_RT;
  // Resets a latched fault: the force fades in again. False without a fault, or if its cause persisted within the last
  // kQuietBeforeReset.
  bool reset() CELL_RT;

  // One tick: read, validate, move, answer. True where `sample` holds new joint values of the instrument (every joint,
  // within its limits; sequence and times of the device's sample): in phases other than closed, waiting and faulted.
  bool step(const TickInput& input, JointSample& sample) CELL_RT;

  // All that the next ticks depend on but instrument and port, for a recording of the tick
  // (rt_core/base/state_bytes.hpp). Of an open channel.
  template <class Archive>
  void transfer(Archive& archive) CELL_RT {
    archive(state_, gate_, validator_, models_, map_, proxy_, coupling_, tissue_, passivity_, re_engagement_, target_,
            posture_);
    transfer_tip(archive);
    archive(held_force_, stored_energy_, reaction_, coupling_force_, passed_, was_engaged_, output_, last_tick_,
            last_bad_);
  }
  // Not for the tick: as it was written. `instrument` and `port` as in open(). False, and it is closed, where it is
  // no state of an open channel.
  template <class Archive>
  [[nodiscard]] bool restore(Archive& in, const Instrument& instrument, HapticDevicePort& port) {
    open(instrument, port);
    transfer(in);
    if (in.ok() && used()) return true;
    close();
    return false;
  }

  [[nodiscard]] bool used() const CELL_RT { return state_.phase != HapticPhase::closed; }
  [[nodiscard]] const HapticState& state() const CELL_RT { return state_; }

 private:
  HapticFault look(const TickInput& input, bool& fresh) CELL_RT;
  [[nodiscard]] bool counts_while_waiting(HapticFault fault) const CELL_RT;
  void latch(HapticFault fault) CELL_RT;
  void take_back_fault() CELL_RT;
  void engage_again_where_safe(Timestamp now) CELL_RT;
  void wait_or_engage(const TickInput& input, bool ready) CELL_RT;
  void engage(const TickInput& input) CELL_RT;
  void yield_to_what_appeared() CELL_RT;
  void restart_force() CELL_RT;
  void work_clutch() CELL_RT;
  void move_and_answer(const TickInput& input) CELL_RT;
  void stand_at(const Eigen::Vector3d& x_before) CELL_RT;
  Eigen::Vector3d answer(const ProxyContact& contact, double period) CELL_RT;
  Eigen::Vector3d feel_tissue(const ProxyContact& contact, double period) CELL_RT;
  void spread(const ProxyContact& contact, const Eigen::Vector3d& force_device) CELL_RT;
  void write(Timestamp now, Nanoseconds period) CELL_RT;
  void write_forces() CELL_RT;
  void fill(JointSample& sample) const CELL_RT;

  // A column of the Jacobian for each variable of the chain, whether the channel was engaged yet or not.
  template <class Archive>
  void transfer_tip(Archive& archive) CELL_RT {
    archive(tip_.X_BE, tip_.error, tip_.met);
    const auto variables = static_cast<Eigen::Index>(instrument_->chain.variable_count());
    if constexpr (Archive::kReads) tip_.J.resize(6, variables);
    for (Eigen::Index i = 0; i < variables; ++i) {
      Eigen::Matrix<double, 6, 1> column = Eigen::Matrix<double, 6, 1>::Zero();
      if (i < tip_.J.cols()) column = tip_.J.col(i);
      archive(column);
      if constexpr (Archive::kReads) tip_.J.col(i) = column;
    }
  }

  HapticState state_;
  const Instrument* instrument_ = nullptr;
  ForceGate gate_;
  SampleValidator validator_;
  ModelWatch models_;
  InstrumentMap map_;
  Proxy proxy_;
  VirtualCoupling coupling_;
  TissueCoupling tissue_;
  Passivity passivity_;
  ReEngagement re_engagement_;
  TipTarget target_;
  Posture posture_;
  TipPosture tip_;                                        // of posture_, in the base
  Eigen::Vector3d held_force_ = Eigen::Vector3d::Zero();  // N, at the device, world axes: what it has now
  double stored_energy_ = 0;                              // J, in spring and tissue, as the device feels it
  TissueReaction reaction_;                               // of the tissue in this tick, before the limits
  double coupling_force_ = 0;                             // N, of the cell, of the spring in this tick, likewise
  double passed_ = 1;                                     // share of the force that controller and limits let through
  bool was_engaged_ = false;                              // since it was opened, or the last reset
  HapticOutput output_;
  Timestamp last_tick_;
  Timestamp last_bad_;
};

}  // namespace cellmirror::haptics
