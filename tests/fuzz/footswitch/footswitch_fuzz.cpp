// A hostile writer: any row of bytes, looked at at any times. The first byte is the debounce time in ms, the second the
// size of the memory; then each look takes a byte for the time that has passed and the memory's bytes.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <span>
#include <vector>

#include "drivers/footswitch/switch_edges.hpp"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  using namespace cellmirror::footswitch;
  if (size < 2) return 0;
  const Nanoseconds ms{1'000'000};
  const std::size_t bytes = 1 + data[1] % 16;
  SwitchEdges sut(bytes, data[0] * ms);
  Timestamp now{1'000'000'000};
  std::map<std::uint32_t, bool> told;
  std::vector<SwitchEdge> edges;
  bool first = true;
  for (std::size_t at = 2; at < size; at += 1 + bytes) {
    now = now + (1 + data[at]) * ms;
    const std::span<const std::uint8_t> rest(data + at + 1, size - at - 1);
    edges.clear();
    sut.look(rest.first(std::min(bytes, rest.size())), now, edges);
    require(!first || edges.empty());
    if (first) {
      for (std::size_t i = 0; i < 8 * bytes; ++i)
        told[static_cast<std::uint32_t>(i + 1)] = ((sut.reported()[i / 8] >> (i % 8)) & 1U) != 0;
    }
    first = false;
    require(edges.size() <= 16 * bytes);
    for (const SwitchEdge& edge : edges) {
      require(edge.input >= 1 && edge.input <= 8 * bytes);
      require(edge.on != told[edge.input]);
      require(edge.time <= now && edge.not_told < now);
      told[edge.input] = edge.on;
    }
  }
  return 0;
}
