// Any bytes in any pieces from a controller: samples are finite, nothing waits beyond its bound, and the phase goes
// only forwards. The first byte: how long pieces are.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "drivers/rtde/rtde_session.hpp"
#include "rt_core/base/contract.hpp"

namespace {

using namespace cellmirror;

struct Checker final : rtde::SessionOutput {
  void send(std::span<const std::uint8_t> bytes) override { CELLMIRROR_EXPECTS(bytes.size() >= 3); }
  void sample(const JointSample& one) override {
    CELLMIRROR_EXPECTS((one.present & one.refused) == 0);
    for (std::size_t i = 0; i < rtde::kJoints; ++i)
      CELLMIRROR_EXPECTS(std::isfinite(one.position[i]) && std::isfinite(one.velocity[i]));
  }
  void rejected(const std::string& why) override { CELLMIRROR_EXPECTS(!why.empty()); }
  void message(const std::string&) override {}
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  RtdeStreamConfig config;
  for (std::size_t i = 0; i < rtde::kJoints; ++i) config.joints.push_back({.joint = i, .number = i});
  Checker out;
  rtde::RtdeSession session(config, out);
  session.begin(Timestamp{1});
  const std::size_t piece = 1 + data[0];
  auto phase = session.phase();
  std::int64_t now = 1;
  for (std::size_t at = 1; at < size; at += piece) {
    session.receive(std::span(data + at, std::min(piece, size - at)), Timestamp{now += 1'000'000});
    CELLMIRROR_EXPECTS(session.phase() >= phase);
    phase = session.phase();
  }
  for (std::size_t at = 1; at + 3 < size; at += 64) {
    const auto payload = std::span(data + at, std::min<std::size_t>(64, size - at));
    static_cast<void>(rtde::decode_version_request(payload));
    static_cast<void>(rtde::decode_outputs_request(payload));
  }
  return 0;
}
