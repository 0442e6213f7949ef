#include "drivers/dds/process/bytes_type.hpp"

#include <algorithm>
#include <cstring>

namespace cellmirror::dds {

BytesType::BytesType(const std::string& name) {
  setName(name.c_str());
  m_typeSize = 1024;  // where buffers start; they grow with what arrives
  m_isGetKeyDefined = false;
  auto_fill_type_information(false);
  auto_fill_type_object(false);
}

bool BytesType::serialize(void* data, eprosima::fastrtps::rtps::SerializedPayload_t* payload) {
  const auto& bytes = static_cast<const BytesSample*>(data)->payload;
  if (bytes.size() > payload->max_size) return false;
  if (!bytes.empty()) std::memcpy(payload->data, bytes.data(), bytes.size());
  payload->length = static_cast<std::uint32_t>(bytes.size());
  payload->encapsulation = CDR_LE;
  return true;
}

bool BytesType::deserialize(eprosima::fastrtps::rtps::SerializedPayload_t* payload, void* data) {
  auto& sample = *static_cast<BytesSample*>(data);
  auto& bytes = sample.payload;
  sample.received = payload->length;
  const auto* first = reinterpret_cast<const std::byte*>(payload->data);
  const bool usable = first != nullptr && payload->length <= kMaxPayloadBytes;
  bytes.assign(first, usable ? first + payload->length : first);
  sample.start = {};
  if (first != nullptr) std::memcpy(sample.start.data(), first, std::min<std::size_t>(payload->length, kStartBytes));
  return true;
}

std::function<std::uint32_t()> BytesType::getSerializedSizeProvider(void* data) {
  return [data] { return static_cast<std::uint32_t>(static_cast<const BytesSample*>(data)->payload.size()); };
}

}  // namespace cellmirror::dds
