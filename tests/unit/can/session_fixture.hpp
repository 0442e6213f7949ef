// A mirror's session in virtual time, with what it sends, samples and tells.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "drivers/can/cia402/plan.hpp"
#include "drivers/can/cia402/session.hpp"
#include "tests/unit/can/frames.hpp"

namespace cellmirror::can {

struct Recorder : Cia402SessionOutput {
  Frames frames;
  std::vector<JointSample> samples;
  std::vector<Cia402Event> events;
  bool bus_works = true;

  bool send(const CanFrame& frame) override {
    if (bus_works) frames.push_back(frame);
    return bus_works;
  }
  void sample(const JointSample& s) override { samples.push_back(s); }
  void event(const Cia402Event& e) override { events.push_back(e); }

  Frames take() { return std::exchange(frames, {}); }
  std::vector<Cia402EventKind> kinds() {
    std::vector<Cia402EventKind> result;
    for (const Cia402Event& e : events) result.push_back(e.kind);
    events.clear();
    return result;
  }
};

inline Cia402NodeConfig node(int id, std::size_t joint) {
  Cia402NodeConfig config;
  config.node_id = static_cast<std::uint8_t>(id);
  config.joint = joint;
  config.joint_name = "J_" + std::to_string(joint + 1);
  config.scale = 0.001;
  return config;
}

struct SessionTest : testing::Test {
  Cia402StreamConfig config;
  Recorder out;
  Timestamp now{10'000'000'000};
  std::unique_ptr<Cia402Session> sut;

  SessionTest() {
    config.nodes = {node(3, 0), node(4, 1)};
    config.heartbeat_timeout = Nanoseconds{0};
  }
  void start() {
    Diagnostics diagnostics;
    auto plan = plan_cia402(config, diagnostics);
    ASSERT_TRUE(plan) << diagnostics.text();
    sut = std::make_unique<Cia402Session>(std::move(*plan), out);
    sut->start(now);
  }
  void at(Nanoseconds later) {
    now = now + later;
    sut->advance(now);
  }
  // Statusword "operation enabled" and a position.
  void tpdo(int id, int position) {
    sut->receive(frame(0x180U + static_cast<unsigned>(id), {0x37, 0x02, position & 0xFF, position >> 8 & 0xFF,
                                                            position >> 16 & 0xFF, position >> 24 & 0xFF}),
                 now);
  }
  // Node 3 takes all that is written by SDO.
  void accept_configuration() {
    for (Frames sent = out.take(); !sent.empty() && sent.back().id == 0x603; sent = out.take()) {
      const auto& request = sent.back().data;
      sut->receive(frame(0x583, {0x60, request[1], request[2], request[3], 0, 0, 0, 0}), now);
    }
  }
};

}  // namespace cellmirror::can
