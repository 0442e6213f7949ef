// The cells that a wall shows (wall.toml). Plain data.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "rt_core/base/time.hpp"
#include "rt_core/ports/dds_network.hpp"
#include "rt_core/ports/ros_presence.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror {

inline constexpr std::size_t kMostWallCells = 1'000;
inline constexpr std::size_t kMostWallThumbnails = 64;
inline constexpr int kDefaultWallPort = 8430;

// A cell that is expected.
struct WallCell {
  std::string name;            // as its cell file calls it
  std::string title = {};      // for people; empty: the name
  std::string host = {};       // of its gateway; empty: any
  std::string instance = {};   // of its gateway on that host; empty: any
  std::string page = {};       // where the browser of the wall reaches its monitor page, as a URL; empty: unknown
  std::string thumbnail = {};  // the DDS topic of its pictures; empty: none
  std::string partition = {};  // of that topic; empty: the default one

  bool operator==(const WallCell&) const = default;
};

struct WallSettings {
  int port = kDefaultWallPort;        // of the page
  std::string address = "127.0.0.1";  // numeric; another one than loopback only where allow_remote says so
  int domain = 0;                     // of DDS
  std::string interface_address = "127.0.0.1";
  std::string topic = "rt/cellmirror/summary";
  Nanoseconds silent_after{3'000'000'000};  // gateways publish twice a second
  DdsSecurityConfig security = {};
  RosPresence ros = {};
  DdsNetworkConfig network = {};
  std::vector<WallCell> cells;  // empty: whatever is discovered, none of it unexpected
};

}  // namespace cellmirror
