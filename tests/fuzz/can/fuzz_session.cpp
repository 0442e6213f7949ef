// Any frames in any order into the mirror's role, with SYNC, heartbeats and configuration by SDO switched on.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <utility>

#include "drivers/can/cia402/session.hpp"
#include "tests/fuzz/can/frame_source.hpp"

namespace {

using namespace cellmirror;

struct Output : can::Cia402SessionOutput {
  std::uint64_t sequence = 0;
  bool send(const CanFrame& frame) override {
    if (frame.length > 8 || frame.id > 0x7FF) std::abort();
    return frame.data[0] != 0xAA;
  }
  void sample(const JointSample& sample) override {
    if (sample.sequence != ++sequence) std::abort();
    for (const double position : sample.position) {
      if (!std::isfinite(position)) std::abort();
    }
  }
  void event(const can::Cia402Event& event) override {
    if (event.node > 2) std::abort();
  }
};

can::Cia402Plan plan() {
  Cia402StreamConfig config;
  config.sync_period = std::chrono::milliseconds(10);
  config.heartbeat_producer_ms = 100;
  for (std::uint8_t id = 1; id <= 3; ++id) {
    Cia402NodeConfig node;
    node.node_id = id;
    node.joint = id;
    node.configure = id != 2;
    if (id == 3) {
      node.tpdos = {{.number = 1,
                     .cob_id = 0x20000123,
                     .transmission_type = 2,
                     .entries = {{0x6064, 0, 32}, {0, 0, 3}, {0x6041, 0, 16}}},
                    {.number = 2, .transmission_type = 1, .entries = {{0x606C, 0, 32}, {0x6077, 0, 16}}}};
    }
    config.nodes.push_back(node);
  }
  Diagnostics diagnostics;
  auto result = can::plan_cia402(config, diagnostics);
  if (!result) std::abort();
  return std::move(*result);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const can::Cia402Plan kPlan = plan();
  Output output;
  can::Cia402Session session(kPlan, output);
  Timestamp now{1'000'000'000};
  session.start(now);
  FrameSource source(data, size);
  while (const auto frame = source.next(now)) {
    session.receive(*frame, now);
    session.advance(now);
  }
  (void)can::condition(session.nodes(), now);
  return 0;
}
