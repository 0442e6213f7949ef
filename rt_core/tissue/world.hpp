// All deformable objects of a cell, what connects them, the instruments that act on them and the effects. No threads,
// no clock, no files: the caller calls step() once a millisecond of simulated time. One thread at a time.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/tissue_state.hpp"
#include "rt_core/tissue/description/command.hpp"
#include "rt_core/tissue/description/description.hpp"
#include "rt_core/tissue/description/step.hpp"

namespace cellmirror::tissue {

class World {
 public:
  // Makes lattices and everything derived: seconds for large objects. An error names file and remedy.
  static Result<World> make(std::vector<ObjectDescription> objects, std::vector<Connection> connections);
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;
  ~World();

  void apply(const Command& command);
  // One millisecond. Bounded; takes heap memory only where something is cut.
  void step(const StepInput& input);

  [[nodiscard]] std::span<const InstrumentResponse> responses() const;
  // Events of the last step.
  [[nodiscard]] std::span<const TissueEvent> events() const;
  void describe(TissueState& state) const;
  // `network`: also the nodes of eladyn_show_def.
  void view(TissueView& view, bool network) const;
  [[nodiscard]] std::size_t object_count() const;

 private:
  struct Parts;
  explicit World(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace cellmirror::tissue
