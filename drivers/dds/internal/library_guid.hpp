// GUIDs of the library as ours. Includes the library's headers.
#pragma once

#include <fastdds/rtps/common/Guid.h>

#include <cstddef>

#include "drivers/dds/ros_graph.hpp"

namespace cellmirror::dds {

[[nodiscard]] inline Guid guid_of(const eprosima::fastrtps::rtps::GUID_t& guid) {
  Guid out{};
  std::size_t at = 0;
  for (const auto byte : guid.guidPrefix.value) out[at++] = byte;
  for (const auto byte : guid.entityId.value) out[at++] = byte;
  return out;
}

}  // namespace cellmirror::dds
