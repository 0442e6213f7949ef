// Any frames in any order to an I/O node that the gateway answers for.
#include <cstdint>

#include "drivers/can/cia401/io_node.hpp"
#include "tests/fuzz/can/checked_output.hpp"
#include "tests/fuzz/can/frame_source.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  CheckedOutput output;
  can::IoNode node(1, 50, output);
  Timestamp now{1'000'000'000};
  node.power_on(now);
  IoInputs inputs;
  FrameSource source(data, size);
  while (const auto frame = source.next(now)) {
    receive_checked(node, output, *frame, now);
    inputs.digital = inputs.digital * 2 + 1;
    inputs.analogue[0] = static_cast<std::int16_t>(inputs.analogue[0] + 9999);
    node.set_inputs(inputs, now);
    node.advance(now);
  }
  return 0;
}
