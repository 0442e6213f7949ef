// Commands that arrive on the command topic: {"command": "ROBOT R1 online", "id": 7}. Pure, of any bytes.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::mqtt {

inline constexpr std::size_t kMostCommandBytes = 16'384;  // of a message
inline constexpr std::size_t kMostIdBytes = 128;

struct CommandRequest {
  std::string command;  // whether it is SCRIPT is the receiver's to check
  std::string id;       // as JSON: a text or a whole number; empty: none
};

// `id` is set where it could be read, also of what is refused, so that the sender knows what the answer is for.
[[nodiscard]] Result<CommandRequest> parse_command(std::string_view payload, std::string& id);

// So many commands a second, and twice as many at once. No clock: times go in.
class CommandGate {
 public:
  explicit CommandGate(double per_second) : per_second_(per_second), left_(2 * per_second) {}
  [[nodiscard]] bool admit(Timestamp now);

 private:
  double per_second_;
  double left_;
  Timestamp last_;
};

}  // namespace cellmirror::mqtt
