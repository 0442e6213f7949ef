#include "drivers/dds/ros_graph.hpp"

#include <algorithm>

#include "drivers/dds/cdr.hpp"

namespace cellmirror::dds {

namespace {

constexpr std::size_t kLargestGid = 24;

void write_gid(const Guid& guid, std::size_t bytes, CdrWriter& out) {
  std::array<std::uint8_t, kLargestGid> gid{};
  std::ranges::copy(guid, gid.begin());
  out.write_bytes(std::span(gid).first(bytes));
}

void write_gids(const std::vector<Guid>& guids, std::size_t bytes, CdrWriter& out) {
  out.write_count(guids.size());
  for (const Guid& guid : guids) write_gid(guid, bytes, out);
}

}  // namespace

std::size_t gid_bytes(RosDistribution distribution) {
  return distribution == RosDistribution::humble ? kLargestGid : std::tuple_size_v<Guid>;
}

void encode(const RosGraph& graph, RosDistribution distribution, std::vector<std::byte>& out) {
  const std::size_t bytes = gid_bytes(distribution);
  CdrWriter writer(out);
  write_gid(graph.participant, bytes, writer);
  writer.write_count(1);
  writer.write_text("/");
  writer.write_text(graph.node);
  write_gids(graph.readers, bytes, writer);
  write_gids(graph.writers, bytes, writer);
}

}  // namespace cellmirror::dds
