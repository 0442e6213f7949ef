// A Cyclone DDS peer whose type is called like ROS 2's JointState and holds random bytes.
//   dds_garbage_peer DOMAIN TOPIC SEED   publishes every millisecond until it is ended
#include <dds/dds.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <thread>
#include <vector>

#include "garbage.h"

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const auto domain = static_cast<dds_domainid_t>(std::atoi(argv[1]));
  dds_create_domain(domain, R"(
<Domain><General><Interfaces><NetworkInterface name="lo"/></Interfaces></General>
<Discovery><ParticipantIndex>auto</ParticipantIndex><Peers><Peer address="127.0.0.1"/></Peers></Discovery></Domain>)");
  const dds_entity_t participant = dds_create_participant(domain, nullptr, nullptr);
  const dds_entity_t topic =
      dds_create_topic(participant, &sensor_msgs_msg_dds__JointState__desc, argv[2], nullptr, nullptr);
  const dds_entity_t writer = dds_create_writer(participant, topic, nullptr, nullptr);
  if (writer < 0) return 1;
  std::mt19937 random(static_cast<std::uint32_t>(std::atoi(argv[3])));
  for (;;) {
    std::vector<std::uint8_t> rest(random() % 600);
    for (auto& byte : rest) byte = static_cast<std::uint8_t>(random() % 4 == 0 ? random() : 0);
    const auto n = static_cast<std::uint32_t>(rest.size());
    const sensor_msgs_msg_dds__JointState_ sample{
        static_cast<std::uint32_t>(random()), static_cast<std::uint32_t>(random()), {n, n, rest.data(), false}};
    dds_write(writer, &sample);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}
