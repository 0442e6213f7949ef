// The file with the user and the password for the broker. What is in it is never in a message of ours.
#pragma once

#include <string>
#include <string_view>

#include "rt_core/base/result.hpp"

namespace cellmirror::mqtt {

struct Credentials {
  std::string user;
  std::string password;
};

// Two lines: user, password. UTF-8 without control characters, each up to 1024 bytes.
[[nodiscard]] Result<Credentials> parse_credentials(std::string_view text);
// Refused: a file that is not the gateway's user's (or root's), or that others may read (mode 0600 is right).
[[nodiscard]] Result<Credentials> read_credentials(const std::string& file);

}  // namespace cellmirror::mqtt
