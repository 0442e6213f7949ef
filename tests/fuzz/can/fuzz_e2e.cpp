// Any format of protection over any frame: what was protected is sound, one bit off is not.
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "drivers/can/e2e/e2e.hpp"

namespace {

using namespace cellmirror;

struct Bytes {
  std::span<const std::uint8_t> left;
  std::uint8_t next() {
    if (left.empty()) return 0;
    const std::uint8_t byte = left.front();
    left = left.subspan(1);
    return byte;
  }
  std::uint16_t word() { return static_cast<std::uint16_t>(next() | next() << 8U); }
};

can::DbcSignal field(Bytes& in, const char* name) {
  can::DbcSignal signal;
  signal.name = name;
  signal.start = static_cast<std::uint16_t>(in.next() % 64U);
  signal.length = static_cast<std::uint16_t>(1U + in.next() % 16U);
  signal.order = in.next() % 2U == 0 ? can::ByteOrder::little_endian : can::ByteOrder::big_endian;
  return signal;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes in{{data, size}};
  can::DbcMessage message;
  message.name = "M";
  message.length = static_cast<std::uint8_t>(in.next() % 65U);
  for (const char* name : {"Counter", "Crc"}) {
    can::DbcSignal signal = field(in, name);
    if (can::bytes_needed(signal) <= message.length) message.signals.push_back(signal);
  }
  E2eConfig config;
  config.message = "M";
  config.profile = static_cast<E2eProfile>(in.next() % 4U);
  config.data_id_mode = static_cast<E2eDataIdMode>(in.next() % 4U);
  config.max_delta = in.next();
  config.counter_signal = "Counter";
  config.crc_signal = "Crc";
  config.crc = {.width = static_cast<std::uint8_t>(in.next() % 2U == 0 ? 8 : 16),
                .polynomial = static_cast<std::uint16_t>(in.word() | 1U),
                .initial = in.word(),
                .final_xor = in.word()};
  config.last_counter = in.word();
  for (unsigned i = in.next() % 17U; i > 0; --i) config.data_id.push_back(in.word());
  const auto format = can::make_e2e_format(config, message);
  if (!format) return 0;
  can::E2eChecker checker(*format);
  std::vector<std::uint8_t> frame(message.length);
  for (std::uint8_t& byte : frame) byte = in.next();
  static_cast<void>(checker.check(frame));
  const auto counter = static_cast<std::uint16_t>(in.word() % (format->last_counter + 1U));
  can::protect(*format, counter, frame);
  if (can::E2eChecker(*format).check(frame).status != can::E2eStatus::initial) std::abort();
  static_cast<void>(checker.check(frame));
  if (checker.check(frame).status != can::E2eStatus::repeated) std::abort();
  // Any polynomial with the term 1 finds a single bit, but in a counter that chooses the data id as well.
  const bool counter_chooses = format->profile == E2eProfile::p02 || format->data_id_mode == E2eDataIdMode::alternating;
  if (counter_chooses) return 0;
  std::uint8_t& byte = frame[in.next() % frame.size()];
  byte = static_cast<std::uint8_t>(byte ^ 1U << in.next() % 8U);
  if (checker.check(frame).good()) std::abort();
  return 0;
}
