// The shared memory of a ring as a confined process may leave it: each pair of bytes of the input changes one byte,
// then both sides use the ring.
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "rt_core/base/contract.hpp"
#include "rt_core/rt/shared_message_ring.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  constexpr std::size_t kCapacity = 128;
  constexpr std::size_t kLongest = 64;
  alignas(SharedRingHeader::kLine) std::array<std::byte, shared_ring_bytes(kCapacity)> memory{};
  SharedRingWriter writer(memory);
  SharedRingReader reader(memory);
  std::vector<std::byte> out;
  const std::array<std::byte, kLongest> message{};
  for (std::size_t i = 0; i + 1 < size; i += 2) {
    memory[(data[i] * 2U) % memory.size()] = static_cast<std::byte>(data[i + 1]);
    static_cast<void>(writer.write(std::span(message).first(data[i + 1] % (kLongest + 1))));
    static_cast<void>(writer.reader_sleeps());
    if (reader.read(out, kLongest) == RingResult::done) CELLMIRROR_EXPECTS(out.size() <= kLongest);
    static_cast<void>(reader.prepare_to_sleep());
  }
  return 0;
}
