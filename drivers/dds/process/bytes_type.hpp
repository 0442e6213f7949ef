// A DDS type whose samples are their serialized bytes, so that our own codec sees exactly what came over the wire.
#pragma once

#include <fastdds/rtps/common/InstanceHandle.h>
#include <fastdds/rtps/common/SerializedPayload.h>
#include <cstddef>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <functional>
#include <string>

#include "drivers/dds/process/bytes_sample.hpp"

namespace cellmirror::dds {

// Announces a name and no type information: Cyclone DDS ignores Fast DDS endpoints that announce theirs.
class BytesType final : public eprosima::fastdds::dds::TopicDataType {
 public:
  explicit BytesType(const std::string& name);

  bool serialize(void* data, eprosima::fastrtps::rtps::SerializedPayload_t* payload) override;
  // Payloads beyond kMaxPayloadBytes arrive empty, which no decoder accepts.
  bool deserialize(eprosima::fastrtps::rtps::SerializedPayload_t* payload, void* data) override;
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override;
  void* createData() override { return new BytesSample; }
  void deleteData(void* data) override { delete static_cast<BytesSample*>(data); }
  bool getKey(void*, eprosima::fastrtps::rtps::InstanceHandle_t*, bool) override { return false; }
};

}  // namespace cellmirror::dds
