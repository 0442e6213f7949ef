// Plants each fault of communication of AUTOSAR's list (PRS_E2EProtocol) in each channel, and compares what the gateway
// finds with the table of docs/plausibility.md.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "tests/unit/faults/channels.hpp"

namespace cellmirror::faults {
namespace {

constexpr Nanoseconds kPeriod{10'000'000};
constexpr Timestamp kStart{1'000'000'000};
constexpr unsigned kMessages = 400;
constexpr unsigned kFault = 150;  // the first message that is concerned

using Events = std::vector<Event>;

Timestamp due(unsigned n) { return kStart + kPeriod * n; }

Events sound() {
  Events events;
  for (unsigned n = 0; n < kMessages; ++n) events.push_back({due(n), n, Content::good});
  return events;
}

struct Fault {
  const char* name;
  std::function<void(Events&)> plant;
};

void one_is(Events& events, Content content) { events[kFault].content = content; }

void all_are(Events& events, Content content) {
  for (unsigned n = kFault; n < kMessages; ++n) events[n].content = content;
}

// Half a period after each message one of another sender.
void insert_foreign(Events& events) {
  for (unsigned n = kFault; n < kMessages; ++n) events.push_back({due(n) + kPeriod / 2, n, Content::foreign});
}

void without(Events& events, unsigned count) {
  const auto first = events.begin() + kFault;
  events.erase(first, first + count);
}

const std::array<Fault, 11> kFaults = {{
    {"repetition", [](Events& e) { e.push_back({due(kFault) + kPeriod / 2, kFault, Content::good}); }},
    {"loss", [](Events& e) { without(e, 1); }},
    {"delay",
     [](Events& e) {
       for (unsigned n = kFault; n < kMessages; ++n) e[n].time = due(n + 30);
     }},
    {"insertion", insert_foreign},
    {"masquerade", [](Events& e) { all_are(e, Content::foreign); }},
    {"wrong address", [](Events& e) { one_is(e, Content::other_address); }},
    {"wrong sequence", [](Events& e) { std::swap(e[kFault].n, e[kFault + 1].n); }},
    {"corruption", [](Events& e) { one_is(e, Content::corrupt); }},
    {"asymmetric", [](Events&) { /* this receiver gets what was sent */ }},
    {"subset of the receivers", [](Events& e) { without(e, 5); }},
    {"blocked", [](Events& e) { without(e, kMessages - kFault); }},
}};

std::string class_of(Nanoseconds delay) {
  if (delay <= 2 * kPeriod) return "at once";
  if (delay <= 9 * kPeriod) return "within 10 messages";
  return delay <= 15 * kPeriod ? "after stale_after_s" : "later";
}

// What is found, and when; looks every millisecond.
std::string outcome(const std::function<std::unique_ptr<Channel>()>& make, const Fault& fault) {
  Events events = sound();
  fault.plant(events);
  std::ranges::stable_sort(events, {}, &Event::time);
  const auto channel = make();
  std::size_t next = 0;
  for (Timestamp now = kStart; now < due(kMessages); now = now + Nanoseconds(1'000'000)) {
    for (; next < events.size() && events[next].time <= now; ++next) channel->receive(events[next]);
    const std::string found = channel->finding(now);
    if (found.empty()) continue;
    if (now < due(kFault)) return "FOUND BEFORE IT WAS PLANTED: " + found;
    return fmt::format("{}, {}", found, class_of(now - due(kFault)));
  }
  return "no";
}

std::string table() {
  const std::array<std::function<std::unique_ptr<Channel>()>, 6> channels = {
      make_cia402_channel, make_protected_dbc_channel, make_dds_channel,
      make_rtde_channel,   make_script_channel,        make_haptic_channel};
  std::string head = "| fault |";
  std::string line = "| --- |";
  for (const auto& make : channels) {
    head += " " + make()->name() + " |";
    line += " --- |";
  }
  std::string out = head + "\n" + line + "\n";
  for (const Fault& fault : kFaults) {
    out += fmt::format("| {} |", fault.name);
    for (const auto& make : channels) out += " " + outcome(make, fault) + " |";
    out += "\n";
  }
  return out;
}

TEST(FaultTable, IsTheOneOfTheDocument) {
  const char* given = std::getenv("CELLMIRROR_SOURCE_DIR");
  const std::filesystem::path source = given != nullptr ? given : std::filesystem::current_path().string();
  std::ifstream file(source / "docs/plausibility.md");
  ASSERT_TRUE(file) << "docs/plausibility.md";
  std::ostringstream text;
  text << file.rdbuf();
  const std::string measured = table();
  fmt::print("{}", measured);
  EXPECT_NE(text.str().find(measured), std::string::npos) << "docs/plausibility.md has another table than this:\n"
                                                          << measured;
}

TEST(FaultTable, ASoundChannelHasNoFinding) {
  const Fault none{"none", [](Events&) {}};
  for (const auto& make : {make_cia402_channel, make_protected_dbc_channel, make_dds_channel, make_rtde_channel,
                           make_script_channel, make_haptic_channel}) {
    EXPECT_EQ(outcome(make, none), "no") << make()->name();
  }
}

}  // namespace
}  // namespace cellmirror::faults
