// What happened: counted, numbered, and the last ones kept. No heap memory after construction.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "rt_core/base/time.hpp"
#include "rt_core/ports/tissue_state.hpp"

namespace cellmirror::tissue {

class EventLog {
 public:
  static constexpr std::size_t kKept = 64;                    // for describe()
  static constexpr std::size_t kInStep = 64;                  // of one step; more are only counted
  static constexpr std::uint64_t kStepsBetweenLimits = 1000;  // of the same limit, instrument and object

  struct Source {
    int instrument = -1;  // slot
    int object = -1;
    std::string_view part = {};  // vessel or connection concerned
  };

  EventLog();
  void begin_step(Timestamp time, std::uint64_t step);
  // What is added from now on belongs to the next step.
  void end_step() { ended_ = of_step_.size(); }
  void add(TissueEventKind kind, const Source& source, const Eigen::Vector3d& at, double value);
  // At most one a second for equal sources.
  void add_limit(TissueLimit limit, const Source& source, const Eigen::Vector3d& at, double value);

  [[nodiscard]] std::span<const TissueEvent> of_step() const { return of_step_; }
  [[nodiscard]] const std::array<std::uint64_t, 10>& counts() const { return counts_; }
  void last(std::vector<TissueEvent>& events) const;  // oldest first

 private:
  struct Reported {
    TissueLimit limit{};
    int instrument = -1;
    int object = -1;
    std::uint64_t step = 0;
  };

  void push(TissueEvent event, const Source& source, const Eigen::Vector3d& at, double value);

  Timestamp time_;
  std::uint64_t step_ = 0;
  std::uint64_t number_ = 0;
  std::vector<TissueEvent> of_step_;
  std::size_t ended_ = 0;          // so many of them are of a step that has ended
  std::vector<TissueEvent> kept_;  // ring
  std::size_t oldest_ = 0;
  std::array<std::uint64_t, 10> counts_{};
  std::array<Reported, 32> reported_{};
  std::size_t next_reported_ = 0;
};

}  // namespace cellmirror::tissue
