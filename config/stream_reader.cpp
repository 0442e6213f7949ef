#include "config/stream_reader.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <netinet/in.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "rt_core/base/dds_topic.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

enum class StreamKind { cia402, dbc, dds, rtde };

// "GROUP:PORT" of a udp channel, with an IPv6 group in brackets.
bool is_group_and_port(std::string_view text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) return false;
  std::string group(text.substr(0, colon));
  const auto port = parse_integer(text.substr(colon + 1));
  if (!port || *port < 1 || *port > 65535) return false;
  if (group.starts_with('[') && group.ends_with(']')) {
    in6_addr v6{};
    group = group.substr(1, group.size() - 2);
    return inet_pton(AF_INET6, group.c_str(), &v6) == 1 && v6.s6_addr[0] == 0xFF;
  }
  in_addr v4{};
  return inet_pton(AF_INET, group.c_str(), &v4) == 1 && (ntohl(v4.s_addr) >> 28U) == 0xEU;
}

bool is_interface_name(std::string_view text) {
  constexpr std::size_t kLongest = 15;  // IFNAMSIZ
  return !text.empty() && text.size() <= kLongest &&
         std::ranges::all_of(text, [](char c) { return c > ' ' && c < 0x7F && c != '/' && c != ':'; });
}

// Numeric addresses. A list that is there and empty would take nothing from anybody: an error.
std::vector<std::string> read_allow_from(TableReader& reader) {
  constexpr std::size_t kMostSources = 64;
  const auto sources = reader.texts("allow_from");
  if (!sources) return {};
  if (sources->empty() || sources->size() > kMostSources)
    reader.error("allow_from", fmt::format("allow_from has {} addresses, not 1 to {}", sources->size(), kMostSources));
  for (const std::string& source : *sources) {
    if (!is_address(source))
      reader.error("allow_from", fmt::format("\"{}\" is not a numeric address", printable(source)),
                   "e.g. 192.168.1.20");
  }
  return *sources;
}

}  // namespace

bool is_address(std::string_view text) {
  const std::string address(text);
  in_addr v4{};
  in6_addr v6{};
  return inet_pton(AF_INET, address.c_str(), &v4) == 1 || inet_pton(AF_INET6, address.c_str(), &v6) == 1;
}

bool is_own_address(const std::string& address) {
  const auto same = [&](int family, auto wanted, auto address_of) {
    if (inet_pton(family, address.c_str(), &wanted) != 1) return false;
    const decltype(wanted) any{};
    if (std::memcmp(&wanted, &any, sizeof any) == 0) return true;
    ifaddrs* list = nullptr;
    if (getifaddrs(&list) != 0) return true;  // unknown: do not warn
    bool found = false;
    for (const ifaddrs* entry = list; entry != nullptr && !found; entry = entry->ifa_next) {
      if (entry->ifa_addr == nullptr || entry->ifa_addr->sa_family != family) continue;
      found = std::memcmp(&wanted, address_of(entry->ifa_addr), sizeof wanted) == 0;
    }
    freeifaddrs(list);
    return found;
  };
  if (address.starts_with("127.") || address == "::1") return true;
  return same(AF_INET, in_addr{},
              [](const sockaddr* of) { return &reinterpret_cast<const sockaddr_in*>(of)->sin_addr; }) ||
         same(AF_INET6, in6_addr{},
              [](const sockaddr* of) { return &reinterpret_cast<const sockaddr_in6*>(of)->sin6_addr; });
}

std::optional<std::string> read_own_address(TableReader& reader, std::string_view key) {
  auto address = reader.text(key);
  if (!address) return std::nullopt;
  if (!is_address(*address)) {
    reader.error(key, fmt::format("\"{}\" is not a numeric address", printable(*address)), "e.g. 127.0.0.1");
    return std::nullopt;
  }
  if (!is_own_address(*address)) {
    reader.warning(
        key, fmt::format("no network interface of this machine has the address {}", *address),
        "correct it ('ip address' lists the addresses of this machine), or ignore this if the cell runs on another "
        "machine or the interface comes up later");
  }
  return address;
}

std::optional<std::string> read_topic(TableReader& reader, std::string_view key) {
  const auto written = reader.text(key);
  if (!written || written->empty()) return written;
  const std::string shown = printable(*written);
  std::string topic = dds_topic(*written);
  if (written->starts_with('/') && !is_ros_topic(topic)) {
    reader.error(key, fmt::format("\"{}\" is not a ROS 2 topic", shown),
                 "letters, digits and _ between single slashes, e.g. /joint_states");
  } else if (!topic.starts_with("rt/")) {
    reader.diagnostics().warning(reader.place(key), fmt::format("no ROS 2 topic is called {} on DDS", shown),
                                 fmt::format("write /{} if it is a topic of ROS 2", shown));
  }
  return topic;
}

std::optional<Nanoseconds> read_seconds(TableReader& reader, std::string_view key, double max, bool zero_allowed) {
  const auto value = reader.number(key, {0.0, max, !zero_allowed});
  if (!value) return std::nullopt;
  return Nanoseconds(static_cast<std::int64_t>(std::llround(*value * 1e9)));
}

StreamAges read_ages(TableReader& reader) {
  constexpr double kLongest = 3600.0;
  StreamAges ages;
  ages.stale_after = read_seconds(reader, "stale_after_s", kLongest, false).value_or(ages.stale_after);
  const auto lost = read_seconds(reader, "lost_after_s", kLongest, false);
  ages.lost_after = lost.value_or(std::max(ages.lost_after, ages.stale_after));
  if (lost && *lost < ages.stale_after)
    reader.error("lost_after_s", "lost_after_s is less than stale_after_s", "increase lost_after_s");
  return ages;
}

PlausibilityConfig read_plausibility(TableReader& reader, const StreamAges& ages) {
  constexpr double kLargestFactor = 1e6;
  constexpr double kLongestJitter = 10.0;
  constexpr double kLongestFrozen = 86400.0;
  PlausibilityConfig config;
  config.enabled = reader.boolean("plausibility").value_or(true);
  config.position_margin = reader.number("position_margin", {0.0, kLargestFactor}).value_or(config.position_margin);
  config.velocity_factor = reader.number("velocity_factor", {0.0, kLargestFactor}).value_or(config.velocity_factor);
  config.acceleration_factor =
      reader.number("acceleration_factor", {0.0, kLargestFactor}).value_or(config.acceleration_factor);
  config.arrival_jitter = read_seconds(reader, "arrival_jitter_s", kLongestJitter, true).value_or(ages.stale_after / 2);
  config.frozen_after = read_seconds(reader, "frozen_after_s", kLongestFrozen, true).value_or(config.frozen_after);
  config.plausible_after =
      static_cast<std::uint16_t>(reader.integer("plausible_after", 1, 10000).value_or(config.plausible_after));
  for (const char* key : {"position_margin", "velocity_factor", "acceleration_factor", "arrival_jitter_s",
                          "frozen_after_s", "plausible_after"}) {
    if (!config.enabled && reader.has(key))
      reader.error(key, fmt::format("{} has no effect with plausibility = false", key));
  }
  return config;
}

CanChannelConfig read_channel(TableReader& reader, const FileFinder& files) {
  CanChannelConfig channel;
  reader.require("channel");
  channel.fd = reader.boolean("fd").value_or(false);
  channel.interface = reader.text("interface").value_or("lo");
  if (!is_interface_name(channel.interface))
    reader.error("interface",
                 fmt::format("\"{}\" is not a valid name of a network interface", printable(channel.interface)));
  channel.log_as_fast_as_possible = reader.boolean("log_as_fast_as_possible").value_or(false);
  channel.log_repeat = reader.boolean("log_repeat").value_or(false);
  const auto endpoint = reader.text("channel");
  if (!endpoint) return channel;
  channel.endpoint = *endpoint;
  const std::size_t colon = endpoint->find(':');
  const std::string_view kind = std::string_view(*endpoint).substr(0, colon);
  const std::string_view rest =
      colon == std::string::npos ? std::string_view() : std::string_view(*endpoint).substr(colon + 1);
  const bool is_log = kind == "log";
  if (kind == "socketcan") {
    if (!is_interface_name(rest))
      reader.error("channel", fmt::format("\"{}\" is not a valid name of a CAN interface", printable(rest)),
                   "e.g. socketcan:can0");
  } else if (kind == "udp") {
    if (!is_group_and_port(rest))
      reader.error("channel", fmt::format("\"{}\" is not a multicast group and port", printable(rest)),
                   "e.g. udp:239.74.163.2:43113 or udp:[ff15::1]:43113");
  } else if (is_log) {
    const auto found = files.find(FileUse::log, rest);
    if (!found) {
      reader.error("channel", found.error().what, found.error().remedy);
    } else {
      channel.endpoint = "log:" + found->string();
    }
  } else {
    reader.error("channel", fmt::format("\"{}\" is not a channel", printable(*endpoint)),
                 "it is socketcan:INTERFACE, udp:GROUP:PORT or log:FILE");
  }
  channel.allow_from = read_allow_from(reader);
  if (reader.has("allow_from") && kind != "udp") reader.error("allow_from", "allow_from belongs to a udp: channel");
  for (const char* key : {"log_as_fast_as_possible", "log_repeat"}) {
    if (reader.has(key) && !is_log) reader.error(key, fmt::format("{} belongs to a log: channel", key));
  }
  return channel;
}

std::optional<JointReference> read_joint_reference(TableReader& reader, const RobotFacts* robot) {
  reader.require("joint");
  const auto name = reader.text("joint");
  if (!name) return std::nullopt;
  if (robot == nullptr) return std::nullopt;  // the robot is unknown, which was reported
  const auto at = std::ranges::find(robot->joint_names, *name);
  if (at == robot->joint_names.end()) {
    std::string remedy = did_you_mean(*name, robot->joint_names);
    if (remedy.empty()) remedy = fmt::format("its joints are {}", fmt::join(robot->joint_names, ", "));
    reader.error("joint", fmt::format("the robot has no joint {}", printable(*name)), remedy);
    return std::nullopt;
  }
  const auto number = static_cast<std::size_t>(at - robot->joint_names.begin());
  return JointReference{number, *name, robot->joint_kinds[number]};
}

const RobotFacts* find_robot(const TableReader& reader, const std::string& robot, const RobotDirectory& robots,
                             bool complete) {
  const auto at = robots.find(robot);
  if (at != robots.end()) return &at->second;
  if (!complete) return nullptr;
  std::vector<std::string> ids;
  for (const auto& [id, other] : robots) ids.push_back(id);
  std::string remedy = did_you_mean(robot, ids);
  if (remedy.empty() && !ids.empty()) remedy = fmt::format("the robots are {}", fmt::join(ids, ", "));
  reader.error("robot", fmt::format("there is no robot {}", printable(robot)), remedy);
  return nullptr;
}

std::optional<RobotStream> read_stream(TableReader& reader, const RobotDirectory& robots, bool complete,
                                       const FileFinder& files) {
  RobotStream stream;
  stream.place = reader.place();
  const std::size_t errors_before = reader.diagnostics().errors();
  reader.require("robot");
  reader.require("kind");
  const auto robot = reader.text("robot");
  const RobotFacts* facts = nullptr;
  if (robot) {
    stream.robot = *robot;
    reader.set_where("stream of " + printable(*robot));
    facts = find_robot(reader, *robot, robots, complete);
  }
  const auto kind = reader.choice<StreamKind>("kind", {{"can-cia402", StreamKind::cia402},
                                                       {"can-dbc", StreamKind::dbc},
                                                       {"dds", StreamKind::dds},
                                                       {"rtde", StreamKind::rtde}});
  if (!kind) return std::nullopt;  // which keys belong here depends on it
  switch (*kind) {
    case StreamKind::cia402:
      stream.config = read_cia402(reader, facts, files);
      break;
    case StreamKind::dbc:
      stream.config = read_dbc(reader, facts, files);
      break;
    case StreamKind::dds:
      stream.config = read_dds(reader, facts);
      break;
    case StreamKind::rtde:
      stream.config = read_rtde(reader, facts);
      break;
  }
  reader.finish();
  const bool sound = reader.diagnostics().errors() == errors_before;
  const std::uint32_t given = joints_given_by(stream.config);
  for (std::size_t i = 0; sound && facts != nullptr && i < facts->joint_names.size(); ++i) {
    if ((given >> i & 1U) == 0) stream.joints_without_position.push_back(facts->joint_names[i]);
  }
  return stream;
}

}  // namespace cellmirror
