// Messages of ROS 2 by their definitions: "ros2msg" schemas of MCAP, and the values of CDR messages that they describe.
// Takes any text and any bytes. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/result.hpp"

namespace cellmirror::app {

// One value of a message: "pose.position.x", "name[3]".
struct FlatValue {
  std::string path;
  std::string text;      // as in a table; of numbers the shortest digits that give the same value again
  bool is_text = false;  // in quotes in JSON
};
using FlatMessage = std::vector<FlatValue>;

inline constexpr std::size_t kMostValues = 100'000;  // of one message

class Ros2Schema {
 public:
  // `name`: of the message, "sensor_msgs/msg/JointState"; `text`: its definition and, behind lines of "=" and
  // "MSG: package/Type", those that it uses. Fails where a type is not there, or contains itself.
  [[nodiscard]] static Result<Ros2Schema> parse(std::string_view name, std::string_view text);

  // The values of a message in the order of its definition. Fails where a length reaches beyond its end.
  [[nodiscard]] Result<FlatMessage> flatten(std::span<const std::byte> cdr) const;

 private:
  enum class Count : std::uint8_t { one, fixed, sequence };
  struct Field {
    std::string name;
    std::string type;  // of an element: a primitive, or the name of a definition
    Count count = Count::one;
    std::uint32_t size = 0;  // of a fixed array
  };
  using Definition = std::vector<Field>;
  class Values;

  static Result<Definition> parse_definition(std::string_view package, std::string_view text);
  static Result<Field> parse_field(std::string_view package, std::string_view type, std::string_view name);
  Result<int> height(const std::string& type, std::map<std::string, int, std::less<>>& heights) const;

  std::map<std::string, Definition, std::less<>> definitions_;
  std::string root_;
};

// The values of a JSON message; elements of arrays as above.
[[nodiscard]] Result<FlatMessage> flatten_json(std::string_view text);

}  // namespace cellmirror::app
