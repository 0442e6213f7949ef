// Joint streams from ROS 2's sensor_msgs/JointState on DDS.
#pragma once

#include <memory>

#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/joint_stream.hpp"
#include "rt_core/ports/payload_sink.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::dds {

// The stream of one robot, closed. Streams with the same domain, interface, topic and reliability share one DDS reader,
// each taking the joints that it knows. Fails where the configuration is wrong in itself (domain, topic, joints); what
// the machine lacks (the interface's address) is reported by open(). `clock` outlives the stream.
// Samples are pushed on the thread of its DDS link, one at a time; there `payloads` is given the messages that name a
// joint of this robot, or are malformed: a message that several robots share once, by the one that was opened first.
[[nodiscard]] Result<std::unique_ptr<JointStream>> make_dds_stream(const DdsStreamConfig& config, const Clock& clock,
                                                                   std::shared_ptr<PayloadSink> payloads = {});

}  // namespace cellmirror::dds
