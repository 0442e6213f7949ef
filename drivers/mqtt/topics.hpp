// The topics of a gateway (docs/mqtt.md). Pure.
#pragma once

#include <string>
#include <string_view>

namespace cellmirror::mqtt {

inline constexpr std::size_t kMostLevelBytes = 200;

// A name as one level of a topic: '/', '+', '#', '%', '$' in front, control characters and bytes that are no UTF-8 as
// %XX; cut at kMostLevelBytes. Never empty: "%00" stands for no name.
[[nodiscard]] std::string topic_level(std::string_view name);

class Topics {
 public:
  // `prefix`: one or more levels, as the cell file has them.
  Topics(std::string_view prefix, std::string_view cell);

  [[nodiscard]] std::string state() const { return base_ + "state"; }
  [[nodiscard]] std::string summary() const { return base_ + "summary"; }
  [[nodiscard]] std::string event() const { return base_ + "event"; }
  [[nodiscard]] std::string command() const { return base_ + "command"; }
  [[nodiscard]] std::string reply() const { return base_ + "reply"; }
  [[nodiscard]] std::string joint_states(std::string_view robot) const {
    return base_ + "joint_states/" + topic_level(robot);
  }
  // Whether a caller may ask for its answer there: reply(), or a topic below it without wildcards.
  [[nodiscard]] bool is_reply(std::string_view topic) const;

 private:
  std::string base_;  // with the slash at its end
};

}  // namespace cellmirror::mqtt
