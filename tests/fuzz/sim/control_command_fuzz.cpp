// Control commands and faults come from outside while the program runs: each line is a command or a refusal with words.
// A fault that was accepted then works on a stream of frames.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "sim_devices/faults/can_traits.hpp"
#include "sim_devices/faults/fault_pipeline.hpp"
#include "sim_devices/robot/control_command.hpp"

namespace {

using namespace cellmirror;

void play(const sim::FaultSpec& spec) {
  sim::FaultPipeline<CanFrame> pipeline(1);
  const Timestamp start{1'000'000'000};
  pipeline.schedule().add(spec, start);
  std::vector<sim::Outgoing<CanFrame>> out;
  for (int i = 0; i < 20; ++i) {
    const Timestamp now = start + i * Nanoseconds(50'000'000);
    CanFrame frame;
    frame.id = 0x181;
    frame.length = static_cast<std::uint8_t>(i % 9);
    pipeline.push(now, {now, {1, 1}, sim::MessageKind::sample, frame});
    pipeline.poll(now, out);
  }
  for (const auto& message : out) {
    if (message.message.length > kCanMaxData) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view line(reinterpret_cast<const char*>(data), size);
  const auto command = sim::parse_control_command(line);
  if (!command && command.error().what.empty()) std::abort();
  if (command) {
    if (const auto* fault = std::get_if<sim::AddFault>(&*command)) play(fault->spec);
  }
  return 0;
}
