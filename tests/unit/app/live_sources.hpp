// A gateway with the small cell, whose one robot is read, and nothing else known: what the documents and alarms of a
// moment are made of.
#pragma once

#include <memory>
#include <vector>

#include "app/report/live_document.hpp"
#include "tests/unit/scene/small_cell.hpp"

namespace cellmirror::app {

struct SmallGateway {
  SmallGateway() {
    RobotSnapshot robot;
    robot.id = "ARM";
    picture.robots = {robot};
    RobotState state;
    state.id = "ARM";
    state.joints.resize(1);
    robots = {state};
    picture.collision = std::make_shared<const collision::Settings>();
  }

  // Of what the members are now; valid as long as they are not changed.
  [[nodiscard]] LiveSources sources(Timestamp now) {
    picture.cell = std::make_shared<const CompiledCell>(small.cell);
    picture.display = std::make_shared<const DisplayState>(small.display);
    return {.instance = "default",
            .cell = "small",
            .uptime_s = 12.5,
            .rate_hz = 1000,
            .now = now,
            .loop = loop,
            .cell_state = picture,
            .tick = tick,
            .robots = robots,
            .poses = small.poses,
            .proximity = nullptr,
            .ranges = nullptr,
            .forces = nullptr,
            .queues = {}};
  }

  struct Idle final : Cycle {
    void run(const CycleContext&) CELL_RT override {}
  };

  scene::SmallCell small;
  Idle idle;
  CyclicThread loop{idle, {}};
  CellState picture;
  engine::TickState tick{8};
  std::vector<RobotState> robots;
};

}  // namespace cellmirror::app
