// Which contact model counts: the newest that makes sense and belongs to the instrument, and how old it is.
#pragma once

#include <Eigen/Core>

#include "rt_core/base/real_time.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/haptics/appearance.hpp"
#include "rt_core/haptics/contact_model.hpp"
#include "rt_core/haptics/instrument.hpp"

namespace cellmirror::haptics {

class ModelWatch {
 public:
  void restart() CELL_RT;
  // `newest` null: none exists. A model that is not finite, not of this instrument, or without sequence is ignored;
  // then the last one ages. In a model that is not certain, everything near counts as touching. `x` (m, world):
  // position of the tip.
  void update(const ContactModel* newest, const Instrument& instrument, const Eigen::Vector3d& x) CELL_RT;
  // In the last model a body appeared at the tip (appearance.hpp).
  [[nodiscard]] bool appeared() const CELL_RT { return appeared_; }
  // Null where none ever came.
  [[nodiscard]] const ContactModel* model() const CELL_RT { return known_ ? &model_ : nullptr; }
  [[nodiscard]] bool stale(Timestamp now, Nanoseconds stale_after) const CELL_RT;

  // All that the next ticks depend on, for a recording of the tick (rt_core/base/state_bytes.hpp).
  template <class Archive>
  void transfer(Archive& archive) CELL_RT {
    archive(known_, appeared_, appearance_, model_);
  }

 private:
  bool known_ = false;
  bool appeared_ = false;
  AppearanceWatch appearance_;
  ContactModel model_;
};

}  // namespace cellmirror::haptics
