// From what ultrasonic sensors read to ROS 2 messages. Pure.
#pragma once

#include <string>
#include <string_view>

#include "drivers/dds/range_message.hpp"
#include "rt_core/ports/proximity_state.hpp"
#include "rt_core/ports/robot_state.hpp"

namespace cellmirror::dds {

// "<prefix>/<id>" as ROS 2 allows topics (letters, digits, single underscores, no digit in front). An id that is no
// such name has its other characters replaced and a number of its own appended, so that no two share a topic.
// `kind` stands before an id that begins with a digit.
[[nodiscard]] std::string topic_of(std::string_view kind, std::string_view prefix, std::string_view id);
[[nodiscard]] std::string range_topic(std::string_view prefix, std::string_view id);

// "<path>/beam": the sensor's frame as ROS 2 sees range sensors, the cone opening along x. Our workframe's opens along
// z; the y axes are the same.
[[nodiscard]] std::string beam_frame(const RangeReading& reading);
[[nodiscard]] FramePose beam_frame_pose(const RangeReading& reading);

// False where a number is not finite: such a reading is not published.
[[nodiscard]] bool fill_range(RosTime stamp, const RangeReading& reading, Range& message);

}  // namespace cellmirror::dds
