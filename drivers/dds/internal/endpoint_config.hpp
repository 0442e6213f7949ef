// What a reader or writer of DDS is to be.
#pragma once

#include <string>
#include <string_view>

#include "rt_core/base/result.hpp"

namespace cellmirror::dds {

struct EndpointConfig {
  std::string topic;
  std::string_view type;
  bool reliable = false;
  int depth = 1;
  bool large = false;               // a writer's samples are larger than a datagram: sent by a thread of the library's
  bool transient_local = false;     // a writer gives its history to readers that come later, a reader asks for it
  bool counts_overwritten = false;  // a writer counts samples that it overwrites before a reliable reader has confirmed
                                    // them
};

[[nodiscard]] Result<void> check_topic(std::string_view topic);

}  // namespace cellmirror::dds
