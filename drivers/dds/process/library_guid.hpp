// GUIDs of the library as ours, and the reverse. Includes the library's headers.
#pragma once

#include <fastdds/rtps/common/Guid.h>

#include <cstddef>

#include "drivers/dds/message/dds_message.hpp"

namespace cellmirror::dds {

[[nodiscard]] inline Guid guid_of(const eprosima::fastrtps::rtps::GUID_t& guid) {
  Guid out{};
  std::size_t at = 0;
  for (const auto byte : guid.guidPrefix.value) out[at++] = byte;
  for (const auto byte : guid.entityId.value) out[at++] = byte;
  return out;
}

[[nodiscard]] inline eprosima::fastrtps::rtps::GUID_t library_guid(const Guid& guid) {
  eprosima::fastrtps::rtps::GUID_t out;
  std::size_t at = 0;
  for (auto& byte : out.guidPrefix.value) byte = guid[at++];
  for (auto& byte : out.entityId.value) byte = guid[at++];
  return out;
}

}  // namespace cellmirror::dds
