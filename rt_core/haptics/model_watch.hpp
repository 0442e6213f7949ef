// Which contact model counts: the newest that makes sense, and how old it is.
#pragma once

#include <cstdint>

#include "rt_core/base/real_time.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/haptics/contact_model.hpp"

namespace cellmirror::haptics {

class ModelWatch {
 public:
  void restart() CELL_RT { known_ = false; }
  // `newest` null: none came, or it was taken away. What is not finite, not of this robot, or has no sequence is not
  // taken; then the last one ages. In a model that is not certain, everything near counts as touching.
  void look_at(const ContactModel* newest, std::uint8_t slot) CELL_RT;
  // Null where none ever came.
  [[nodiscard]] const ContactModel* model() const CELL_RT { return known_ ? &model_ : nullptr; }
  [[nodiscard]] bool stale(Timestamp now, Nanoseconds stale_after) const CELL_RT;

 private:
  bool known_ = false;
  ContactModel model_;
};

}  // namespace cellmirror::haptics
