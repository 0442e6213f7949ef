// Ipopt around a formulation, without Ipopt's types. Internal to the folder.
#pragma once

#include <memory>

#include "rt_core/inverse_kinematics/ipopt_formulation.hpp"
#include "rt_core/inverse_kinematics/ipopt_solver.hpp"

namespace cellmirror::inverse_kinematics {

// One program, used again and again: the application, its options and the linear solver's memory stay. One thread at a
// time. Ipopt 3.11 numbers the states of its objects by thread, to know what it has computed already: a call from
// another thread than the last, and one with another number of equations, rebuild the application.
class IpoptProgram {
 public:
  IpoptProgram(const kinematics::Chain& chain, Objective objective, const IpoptSettings& settings);
  ~IpoptProgram();
  IpoptProgram(const IpoptProgram&) = delete;
  IpoptProgram& operator=(const IpoptProgram&) = delete;

  // Nothing is thrown; a failure inside Ipopt gives what was found until then.
  [[nodiscard]] Run run(const Problem& problem);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace cellmirror::inverse_kinematics
