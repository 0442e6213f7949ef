// Reads the summaries of all cells, as the wall does, and prints a line for each: for tests and benchmarks with many
// gateways.
//   dds_summary_peer ADDRESS [DISCOVERY_SERVER...]   servers as ADDRESS:PORT, their numbers in the order given
// {"event": "received" | "rejected" | "gone", "at_s": of CLOCK_MONOTONIC, "sender": GUID, "cell", "run", "sequence",
//  "time_ns", "health", "robots", "bytes"}
#include <chrono>
#include <cstdio>
#include <string>
#include <string_view>
#include <thread>

#include "drivers/dds/network.hpp"
#include "drivers/dds/summary_reader.hpp"
#include "rt_core/base/ipv4_address.hpp"
#include "rt_core/base/json_writer.hpp"

namespace {

using namespace cellmirror;

class Printer final : public dds::SummaryInbox {
 public:
  explicit Printer(const Clock& clock) : clock_(clock) {}

  void received(const dds::ReceivedSummary& got) override {
    JsonWriter out = begin("received", got.sender);
    out.member("cell", got.summary.cell).member("run", got.summary.run).member("sequence", got.summary.sequence);
    out.member("time_ns", got.summary.time_ns).member("health", word(got.summary.health));
    out.member("robots", got.summary.robots.size()).member("bytes", got.bytes);
    print(out);
  }
  void rejected(std::string_view sender, const std::string& why) override {
    JsonWriter out = begin("rejected", sender);
    out.member("why", why);
    print(out);
  }
  void gone(std::string_view sender) override {
    JsonWriter out = begin("gone", sender);
    print(out);
  }

 private:
  [[nodiscard]] JsonWriter begin(std::string_view event, std::string_view sender) const {
    JsonWriter out;
    out.begin_object().member("event", event).fixed_member("at_s", seconds(clock_.now() - Timestamp{}), 6);
    out.member("sender", sender);
    return out;
  }
  static void print(JsonWriter& out) {
    std::puts(out.end_object().take().c_str());
    std::fflush(stdout);
  }

  const Clock& clock_;
};

DdsServer server_of(std::string_view text, std::uint8_t id) {
  const Ipv4Address parsed = parse_ipv4_address(text).value_or(Ipv4Address{});
  return {.address = parsed.address, .port = parsed.port, .id = id};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  DdsNetworkConfig network;
  for (int i = 2; i < argc; ++i)
    network.discovery_servers.push_back(server_of(argv[i], static_cast<std::uint8_t>(i - 2)));
  dds::set_network(network);
  const SystemClock clock;
  Printer printer(clock);
  const auto reader = dds::SummaryReader::open({.interface_address = argv[1]}, clock, printer);
  if (!reader) {
    std::fprintf(stderr, "%s\n", reader.error().text().c_str());
    return 1;
  }
  for (;;) std::this_thread::sleep_for(std::chrono::seconds(1));
}
