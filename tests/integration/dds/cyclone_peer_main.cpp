// A Cyclone DDS peer in a process of its own, to be stopped and killed by tests.
//   dds_cyclone_peer write DOMAIN TOPIC PERIOD_MS   publishes {"a": n} for n = 1, 2, ... until it is ended
//   dds_cyclone_peer read DOMAIN TOPIC              a reliable reader; prints a line for each message
//   dds_cyclone_peer states DOMAIN TOPIC            likewise, with what is in them, as JSON: {"writers": n} when their
//   number has changed, {"stamp_ns": t, "position": {name: value}} for each message
//   dds_cyclone_peer description DOMAIN TOPIC       prints the text that is there for readers that come later; 1 after
//   a minute
//   dds_cyclone_peer controller DOMAIN NAME         commands a controller: a line of standard input is a trajectory,
//   "JOINTS STAMP T:P,P T:P,P:V,V", times in s, stamp 0: now; prints {"reference": [..], "feedback": [..]}
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "cyclone_peer.hpp"

using cellmirror::dds::test::CyclonePeer;

namespace {

int write(CyclonePeer& peer, const std::string& topic, int period_ms) {
  const dds_entity_t writer = peer.joint_state_writer(topic, true);
  for (double n = 1;; ++n) {
    CyclonePeer::write(writer, {.name = {"a"}, .position = {n}});
    std::this_thread::sleep_for(std::chrono::milliseconds(period_ms));
  }
}

int read(CyclonePeer& peer, const std::string& topic) {
  const dds_entity_t reader = peer.joint_state_reader(topic, true);
  for (;;) {
    for (const auto& message : CyclonePeer::take_joint_states(reader)) {
      std::printf("%zu joints\n", message.name.size());
      std::fflush(stdout);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

int states(CyclonePeer& peer, const std::string& topic) {
  const dds_entity_t reader = peer.joint_state_reader(topic, true);
  for (int writers = -1;;) {
    const int matched = CyclonePeer::matched_writers(reader);
    if (matched != writers) std::printf("{\"writers\": %d}\n", writers = matched);
    for (const auto& message : CyclonePeer::take_joint_states(reader)) {
      std::printf("{\"stamp_ns\": %lld, \"position\": {",
                  1'000'000'000LL * message.sec + static_cast<long long>(message.nanosec));
      for (std::size_t i = 0; i < message.name.size() && i < message.position.size(); ++i)
        std::printf("%s\"%s\": %.17g", i == 0 ? "" : ", ", message.name[i].c_str(), message.position[i]);
      std::puts("}}");
    }
    std::fflush(stdout);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

int description(CyclonePeer& peer, const std::string& topic) {
  const dds_entity_t reader = peer.description_reader(topic);
  for (int i = 0; i < 6000; ++i) {
    const auto texts = CyclonePeer::take_texts(reader);
    if (!texts.empty()) return std::fputs(texts.back().c_str(), stdout) < 0 ? 1 : 0;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return 1;
}

std::vector<double> numbers(const std::string& text) {
  std::vector<double> out;
  std::stringstream in(text);
  for (std::string one; std::getline(in, one, ',');) out.push_back(std::strtod(one.c_str(), nullptr));
  return out;
}

void set_time(double t, std::int32_t& sec, std::uint32_t& nanosec) {
  sec = static_cast<std::int32_t>(std::floor(t));
  nanosec = static_cast<std::uint32_t>(std::llround((t - std::floor(t)) * 1e9));
}

cellmirror::dds::test::PlainTrajectory trajectory_of(const std::string& text) {
  cellmirror::dds::test::PlainTrajectory out;
  std::istringstream line(text);
  std::string joints;
  double stamp = 0;
  line >> joints >> stamp;
  set_time(stamp, out.sec, out.nanosec);
  std::stringstream names(joints);
  for (std::string one; std::getline(names, one, ',');) out.joints.push_back(one);
  for (std::string word; line >> word;) {
    std::stringstream parts(word);
    std::string part;
    auto& point = out.points.emplace_back();
    std::getline(parts, part, ':');
    set_time(std::strtod(part.c_str(), nullptr), point.sec, point.nanosec);
    if (std::getline(parts, part, ':')) point.positions = numbers(part);
    if (std::getline(parts, part, ':')) point.velocities = numbers(part);
  }
  return out;
}

void print_numbers(const char* name, const std::vector<double>& values) {
  std::printf("\"%s\": [", name);
  for (std::size_t i = 0; i < values.size(); ++i) std::printf("%s%.17g", i == 0 ? "" : ", ", values[i]);
  std::printf("]");
}

int controller(CyclonePeer& peer, const std::string& name) {
  const dds_entity_t writer = peer.trajectory_writer("rt/" + name + "/joint_trajectory");
  const dds_entity_t reader = peer.controller_state_reader("rt/" + name + "/controller_state");
  std::thread printer([reader] {
    for (;;) {
      for (const auto& state : CyclonePeer::take_controller_states(reader)) {
        std::printf("{");
        print_numbers("reference", state.reference);
        std::printf(", ");
        print_numbers("feedback", state.feedback);
        std::puts("}");
      }
      std::fflush(stdout);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  });
  while (CyclonePeer::matched_readers(writer) == 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  for (std::string line; std::getline(std::cin, line);) CyclonePeer::write(writer, trajectory_of(line));
  printer.join();  // until it is ended
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return 2;
  CyclonePeer peer(std::atoi(argv[2]));
  if (std::string(argv[1]) == "write" && argc == 5) return write(peer, argv[3], std::atoi(argv[4]));
  if (std::string(argv[1]) == "read") return read(peer, argv[3]);
  if (std::string(argv[1]) == "states") return states(peer, argv[3]);
  if (std::string(argv[1]) == "controller") return controller(peer, argv[3]);
  if (std::string(argv[1]) == "description") return description(peer, argv[3]);
  return 2;
}
