// Commands to the edge node of Sparkplug B.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "drivers/mqtt/sparkplug_conversation.hpp"

using namespace cellmirror;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  ManualClock clock;
  mqtt::SparkplugConversation node({"group", "node"}, {"cell", "default", "host", "1"}, clock, [] {});
  static_cast<void>(node.begin());
  node.connected();
  if (!node.next() || node.next()) std::abort();  // NBIRTH
  node.received({.topic = "spBv1.0/group/NCMD/node", .payload = bytes});
  const auto wanted = mqtt::asks_for_rebirth(bytes);
  if (node.next().has_value() != (wanted && *wanted)) std::abort();
  return 0;
}
