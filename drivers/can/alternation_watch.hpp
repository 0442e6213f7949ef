// Whether two senders answer under one identifier: the values of a joint jump between two places and keep coming back.
#pragma once

#include <array>
#include <cstdint>

#include "rt_core/base/time.hpp"

namespace cellmirror::can {

// Of one joint. Pure; some nanoseconds a value.
class AlternationWatch {
 public:
  // A jump is at least this [rad or m], and each way back ends within this share of it from where the jump began. No
  // robot swings like this from sample to sample, for so many samples.
  static constexpr double kSmallestJump = 0.02;
  static constexpr double kReturnShare = 0.1;
  static constexpr unsigned kReturns = 6;               // in succession
  static constexpr Nanoseconds kWindow{1'000'000'000};  // from return to return, and until a conflict is over

  // The newest value, rad or m; true where it is one of two senders'.
  bool take(double value, Timestamp now);

  struct Places {
    double a = 0;  // rad or m
    double b = 0;
  };
  // Where the two are, while there are two.
  [[nodiscard]] Places places() const { return {newest_, other_}; }

 private:
  double newest_ = 0;
  double other_ = 0;  // before the newest jump
  Timestamp taken_;   // when newest_ came
  Timestamp other_taken_;
  Timestamp returned_;
  unsigned returns_ = 0;
};

}  // namespace cellmirror::can
