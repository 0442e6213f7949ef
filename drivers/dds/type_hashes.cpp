#include "drivers/dds/type_hashes.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "drivers/dds/controller_messages.hpp"

namespace cellmirror::dds {

namespace {

using Row = std::pair<std::string_view, std::string_view>;

// Of Jazzy. tests/support/ros2_type_hashes.py computes them.
constexpr std::array kHashes = {
    Row{"sensor_msgs::msg::dds_::JointState_", "a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e"},
    Row{"tf2_msgs::msg::dds_::TFMessage_", "e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"},
    Row{"std_msgs::msg::dds_::String_", "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"},
    Row{"sensor_msgs::msg::dds_::Range_", "b42b62562e93cbfe9d42b82fe5994dfa3d63d7d5c90a317981703f7388adff3a"},
    Row{"geometry_msgs::msg::dds_::WrenchStamped_", "8dc3deaf06b2ab281f9f9a742a8961c328ca7cec16e3fd6586d3a5c83fa78f77"},
    Row{"diagnostic_msgs::msg::dds_::DiagnosticArray_",
        "5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e"},
    Row{"visualization_msgs::msg::dds_::MarkerArray_",
        "86cb8800b6fb05b5eff1abd7a56f62a5641d3ae9a1c29e78e67e704f1d067dcf"},
    Row{"sensor_msgs::msg::dds_::CompressedImage_", "15640771531571185e2efc8a100baf923961a4d15d5569652e6cb6691e8e371a"},
    Row{"trajectory_msgs::msg::dds_::JointTrajectory_",
        "179b33eba59d676f6d967ac71fe35e7ca2f64b2f3928f4a018cec115e213796e"},
    Row{"action_msgs::msg::dds_::GoalStatusArray_", "6c1684b00f177d37438febe6e709fc4e2b0d4248dca4854946f9ed8b30cda83e"},
    Row{"action_msgs::srv::dds_::CancelGoal_Request_",
        "3d3c84653c1f96918086887e1dcb236faec88b81a5b14fd4cf4840065bcdf8af"},
    Row{"action_msgs::srv::dds_::CancelGoal_Response_",
        "35e682cf3f510e83c70a82a4aac888496dedee56773bf9d8e5e0aa81f9e1c960"},
    Row{"control_msgs::action::dds_::FollowJointTrajectory_SendGoal_Request_",
        "179c93691f1f6d1d115881ff88c3917b7cc6eac2ba4bf56766cc7c4389e19ef1"},
    Row{"control_msgs::action::dds_::FollowJointTrajectory_SendGoal_Response_",
        "e6a48ba740ae254500129a877f0b071be8663a115da1a539b74599cc97921fbf"},
    Row{"control_msgs::action::dds_::FollowJointTrajectory_GetResult_Request_",
        "ecf7ea8463d3beec7084bca75216d0b01b87b6e1e4e09679bb26093041efcbe9"},
    Row{"control_msgs::action::dds_::FollowJointTrajectory_GetResult_Response_",
        "08eefbaa146ce02ba45898d5e99160afd6c4c54a30d159aee0f2ca6035b1580f"},
    Row{"control_msgs::msg::dds_::JointTrajectoryControllerState_",
        "51d8dd89cc624cbe9daaeeb4d80d6de9b86168ffdc3be41fefc0953e3c26e480"},
    Row{"rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_",
        "91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e"},
    Row{"control_msgs::action::dds_::FollowJointTrajectory_FeedbackMessage_",
        "80398fcb9674a79081a9906e2ccf0c804dd7cb15e22e362e606ee87186beab71"},
};
constexpr std::string_view kKiltedFeedback = "95618cc73912d99b9acaa17d2da5e832cb0bfdeede7534fa8ec600feca2a6c4b";

}  // namespace

std::string_view type_hash(std::string_view type, RosDistribution distribution) {
  if (distribution == RosDistribution::humble) return {};
  if (distribution == RosDistribution::kilted && type == kFeedbackType) return kKiltedFeedback;
  const auto found = std::ranges::find(kHashes, type, &Row::first);
  return found == kHashes.end() ? std::string_view() : found->second;
}

std::string type_user_data(std::string_view type, RosDistribution distribution) {
  const std::string_view hash = type_hash(type, distribution);
  if (hash.empty()) return {};
  std::string out = "typehash=RIHS01_";
  out += hash;
  return out += ';';
}

}  // namespace cellmirror::dds
