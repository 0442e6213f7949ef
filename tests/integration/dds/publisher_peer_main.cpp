// Our own publisher in a process of its own.
//   dds_publisher_peer DOMAIN TOPIC JOINT   publishes every 10 ms until it is ended; prints a line for each sample
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "drivers/dds/joint_state_publisher.hpp"

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const auto publisher = cellmirror::dds::JointStatePublisher::make({.domain = std::atoi(argv[1]), .topic = argv[2]});
  if (!publisher) {
    std::fprintf(stderr, "%s\n", publisher.error().text().c_str());
    return 1;
  }
  for (double n = 1;; ++n) {
    (*publisher)->publish({.name = {argv[3]}, .position = {n}});
    std::puts("published");
    std::fflush(stdout);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}
