// Any bytes as a DDS sample: JointState into views, values and robots' samples, and TFMessage. What is accepted must
// survive being written and read again.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>
#include <vector>

#include "drivers/dds/joint_state_router.hpp"
#include "drivers/dds/ros2_messages.hpp"

namespace {

using namespace cellmirror;
using namespace cellmirror::dds;

void require(bool condition) {
  if (!condition) std::abort();
}

class CheckingSink final : public JointSampleSink {
 public:
  bool push(const JointSample& sample) noexcept override {
    require((sample.present & sample.refused) == 0);
    for (std::size_t i = 0; i < kMaxJointsPerRobot; ++i) {
      require(std::isfinite(sample.position[i]) && std::isfinite(sample.velocity[i]) &&
              std::isfinite(sample.effort[i]));
    }
    return true;
  }
};

struct Cell {
  Cell() {
    router.add(*first, sink);
    router.add(*second, sink);
  }
  CheckingSink sink;
  std::unique_ptr<RobotFeed> first = RobotFeed::make({{"j1", 0, 1.0, 0.0}, {"j2", 15, -2.0, 0.5}}).value();
  std::unique_ptr<RobotFeed> second = RobotFeed::make({{"j2", 0, 1e-3, 0.0}, {"a", 1, 1.0, 0.0}}).value();
  JointStateRouter router;
};

template <class Message>
void round_trip(std::span<const std::byte> payload) {
  Message message;
  if (decode(payload, message) != CdrFault::none) return;
  std::vector<std::byte> written;
  std::vector<std::byte> again;
  encode(message, written);
  require(decode(written, message) == CdrFault::none);
  encode(message, again);
  require(written == again);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static Cell cell;
  const std::span payload(reinterpret_cast<const std::byte*>(data), size);
  cell.router.accept(payload, Timestamp{1'000'000}, {.publisher = 1, .sequence = size});
  round_trip<JointState>(payload);
  round_trip<TfMessage>(payload);
  return 0;
}
