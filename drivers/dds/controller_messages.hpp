// What a ROS 2 controller publishes of itself, and the messages of its action, as bytes. Pure: no DDS library, no
// clock. Layouts: control_msgs/JointTrajectoryControllerState and FollowJointTrajectory (branches humble, jazzy and
// master of ros-controls/control_msgs), action_msgs, unique_identifier_msgs; of an action rosidl's SendGoal, GetResult
// and FeedbackMessage. SI: rad or m, s.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/dds/cdr.hpp"
#include "drivers/dds/ros2_messages.hpp"
#include "rt_core/ports/joint_trajectory.hpp"
#include "rt_core/ports/ros_presence.hpp"
#include "rt_core/ports/trajectory_endpoint.hpp"

namespace cellmirror::dds {

inline constexpr std::string_view kControllerStateType = "control_msgs::msg::dds_::JointTrajectoryControllerState_";
inline constexpr std::string_view kSendGoalRequestType =
    "control_msgs::action::dds_::FollowJointTrajectory_SendGoal_Request_";
inline constexpr std::string_view kSendGoalReplyType =
    "control_msgs::action::dds_::FollowJointTrajectory_SendGoal_Response_";
inline constexpr std::string_view kGetResultRequestType =
    "control_msgs::action::dds_::FollowJointTrajectory_GetResult_Request_";
inline constexpr std::string_view kGetResultReplyType =
    "control_msgs::action::dds_::FollowJointTrajectory_GetResult_Response_";
inline constexpr std::string_view kFeedbackType = "control_msgs::action::dds_::FollowJointTrajectory_FeedbackMessage_";
inline constexpr std::string_view kCancelRequestType = "action_msgs::srv::dds_::CancelGoal_Request_";
inline constexpr std::string_view kCancelReplyType = "action_msgs::srv::dds_::CancelGoal_Response_";
inline constexpr std::string_view kGoalStatusType = "action_msgs::msg::dds_::GoalStatusArray_";

// Of a controller with these joints.
struct ControllerMessage {
  RosTime stamp;
  std::span<const std::string> joints;
  const ControllerState& state;
};
// The state: Humble's type has `desired` and `actual` too, which are `reference` and `feedback` again; Jazzy's the
// factor of the speed, which is 1.
void encode(const ControllerMessage& message, RosDistribution distribution, std::vector<std::byte>& out);
// The feedback of the action; since Kilted with the number of the point.
void encode_feedback(const GoalId& goal, const ControllerMessage& message, RosDistribution distribution,
                     std::vector<std::byte>& out);

// The contents of requests.
struct GoalRequest {
  TrajectoryGoal goal;
  JointTrajectory trajectory;
};
// Form and limits only; nothing behind points of joints with several axes is read (TrajectoryGoal::multi_dof).
[[nodiscard]] CdrFault decode(CdrReader in, GoalRequest& request);

// action_msgs/CancelGoal. Zeros: all goals, or all of that time and before.
struct CancelRequest {
  GoalId id{};
  RosTime stamp;
};
[[nodiscard]] CdrFault decode(CdrReader in, CancelRequest& request);
// Of the request for a result.
[[nodiscard]] CdrFault decode(CdrReader in, GoalId& id);

// action_msgs/GoalStatus.
enum class GoalStatus : std::int8_t { unknown, accepted, executing, canceling, succeeded, canceled, aborted };
// action_msgs/CancelGoal.
enum class CancelCode : std::int8_t { none, rejected, unknown_goal, terminated };
struct GoalInfo {
  GoalId id{};
  RosTime stamp;
  GoalStatus status = GoalStatus::unknown;
};

// The contents of replies: service_mapping.hpp has what stands around them.
void write_goal_reply(bool accepted, RosTime stamp, CdrWriter& out);
void write_cancel_reply(CancelCode code, std::span<const GoalInfo> goals, CdrWriter& out);
void write_result_reply(GoalStatus status, const GoalResult& result, CdrWriter& out);
void encode_status(std::span<const GoalInfo> goals, std::vector<std::byte>& out);

}  // namespace cellmirror::dds
