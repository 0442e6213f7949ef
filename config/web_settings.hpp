// The monitor page ([web] of a cell file). Plain data.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace cellmirror {

struct WebSettings {
  bool enabled = true;
  std::optional<int> port;            // none: 8420, or a free one for a gateway with a name of its own
  std::string address = "127.0.0.1";  // numeric; another one than loopback only where allow_remote says so
  bool read_only = false;             // no commands
  std::vector<std::string> origins;   // "https://host[:port]": origins of other permitted pages
};

}  // namespace cellmirror
