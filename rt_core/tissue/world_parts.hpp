// What a World is made of. Private to this folder.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rt_core/tissue/contact/connections.hpp"
#include "rt_core/tissue/contact/constraint_system.hpp"
#include "rt_core/tissue/contact/contact.hpp"
#include "rt_core/tissue/contact/rigid_contacts.hpp"
#include "rt_core/tissue/contact/tissue_contacts.hpp"
#include "rt_core/tissue/description/event_log.hpp"
#include "rt_core/tissue/description/limits.hpp"
#include "rt_core/tissue/effects/particles.hpp"
#include "rt_core/tissue/effects/pool.hpp"
#include "rt_core/tissue/effects/surroundings.hpp"
#include "rt_core/tissue/effects/vessels.hpp"
#include "rt_core/tissue/instruments/clips.hpp"
#include "rt_core/tissue/instruments/instrument.hpp"
#include "rt_core/tissue/instruments/instrument_contacts.hpp"
#include "rt_core/tissue/instruments/response.hpp"
#include "rt_core/tissue/instruments/tools.hpp"
#include "rt_core/tissue/world.hpp"

namespace cellmirror::tissue {

inline const Eigen::Vector3d kGravity{0, 0, -9.81};  // m/s2

struct WorldParts {
  std::vector<DeformableObject> objects;
  Connections connections;
  Vessels vessels;
  Clips clips;
  Pool pool;
  Particles particles;
  Surroundings surroundings;
  Limits limits;
  EventLog log;

  std::vector<Instrument> instruments;  // in the order in which they were first met
  std::vector<ResponseEstimate> estimates;
  std::vector<InstrumentResponse> responses;

  InstrumentContacts instrument_contacts;
  RigidContacts rigid_contacts;
  TissueContacts tissue_contacts;
  ContactMemory memory;
  std::vector<Contact> contacts;  // of this step
  ConstraintSystem system;

  bool calculating = true;
  std::uint64_t step = 0;            // since make()
  std::uint64_t steps_of_model = 0;  // since make() or the last reset, while calculating
  Timestamp time;

  // --- commands ---
  Instrument* instrument(int slot);  // added where there is none; null: no room
  void reset();

  // --- a step ---
  void move_instruments(std::span<const InstrumentPose> poses);
  void search(std::span<const RigidBodyPose> bodies);
  void solve_step();
  void apply_limits();
  void use_tools();
  void let_flow();
  void make_responses();

 private:
  // Of one contact, between substeps.
  struct Row {
    std::size_t contact = 0;
    std::size_t push = 0;
    double dt = 0;
    double gap = 0;
  };

  void begin_bodies(std::uint32_t substep, std::uint32_t substeps);
  void add_contacts(double elapsed_s);
  void take_contacts();
  void apply_velocities();
  void follow_limit(LimitActions actions, int instrument, int object);
  void freeze(DeformableObject& object);
  void measure_speed(DeformableObject& object);
  void after_cuts();

  std::vector<Row> rows_;
  std::vector<double> start_;                 // N s in a step: where the next substep starts
  std::vector<Eigen::Vector3d> start_along_;  // of friction
};

struct World::Parts : WorldParts {};

}  // namespace cellmirror::tissue
