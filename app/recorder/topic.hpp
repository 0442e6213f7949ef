// A topic of a recording: what its messages are. Plain data.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "ipc/record/layout.hpp"

namespace cellmirror::app {

// What is left out first while the disk does not keep up.
enum class Importance : std::uint8_t {
  picture,  // left out from a quarter of a buffer on
  bulk,     // frames, status: left out from half a buffer on
  state,    // joints, collisions, ranges, forces: from three quarters on
  event,    // log, commands, events of collisions: only where the buffer is full
};

struct Topic {
  std::string name;             // "/joint_states"
  std::string encoding;         // of messages: "cdr", "json"
  std::string schema_name;      // "sensor_msgs/msg/JointState"
  std::string schema_encoding;  // "ros2msg", "jsonschema"
  std::string schema;
  Importance importance = Importance::state;
  mcap::Texts metadata = {};
  std::string view = {};   // of pictures: what they show, as in WantedPicture
  bool of_tissue = false;  // not recorded where the rate of tissue is 0
};

// A topic is known by its address: two topics of one name are two channels.
using TopicPtr = std::shared_ptr<const Topic>;

}  // namespace cellmirror::app
