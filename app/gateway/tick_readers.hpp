// Who reads what the tick publishes, beside the owner.
#pragma once

#include "rt_core/engine/engine.hpp"

namespace cellmirror::app {

// Workers are named as their threads.
struct TickReaders {
  // `engine`: the engine, or what takes its place.
  template <class Source>
  explicit TickReaders(Source& engine)
      : status(engine.subscribe("status")),
        collisions(engine.subscribe("collisions")),
        ranging(engine.subscribe("ranging")),
        contacts(engine.subscribe("contacts")),
        forces(engine.subscribe("forces")),
        tcp_force(engine.subscribe("tcp-force")),
        traces(engine.subscribe("traces")),
        tissue(engine.subscribe("tissue")),
        publisher(engine.subscribe("publisher")),
        pictures(engine.subscribe("pictures")),
        scene(engine.subscribe("scene")),
        io(engine.subscribe("io")),
        recorder(engine.subscribe("recorder")) {}

  engine::TickReader& status;
  engine::TickReader& collisions;
  engine::TickReader& ranging;
  engine::TickReader& contacts;
  engine::TickReader& forces;
  engine::TickReader& tcp_force;
  engine::TickReader& traces;
  engine::TickReader& tissue;
  engine::TickReader& publisher;
  engine::TickReader& pictures;
  engine::TickReader& scene;
  engine::TickReader& io;
  engine::TickReader& recorder;
};

}  // namespace cellmirror::app
