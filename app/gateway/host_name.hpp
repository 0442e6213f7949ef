// How the machine of the gateway calls itself.
#pragma once

#include <unistd.h>

#include <array>
#include <string>

namespace cellmirror::app {

// Empty where that cannot be known.
[[nodiscard]] inline std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? std::string(name.data()) : std::string();
}

}  // namespace cellmirror::app
