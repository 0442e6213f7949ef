// SENSOR records: whatever is accepted is written back byte for byte.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "ipc/wire/robot_record.hpp"
#include "rt_core/base/contract.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  const auto bytes = std::as_bytes(std::span(data, size));
  const auto record = decode_robot_record(bytes);
  if (!record) {
    CELLMIRROR_EXPECTS(!record.error().what.empty());
    return 0;
  }
  std::array<std::byte, kMaxRobotRecordBytes> again{};
  const auto length = encode_robot_record(*record, again);
  CELLMIRROR_EXPECTS(length && *length == size);
  CELLMIRROR_EXPECTS(std::memcmp(again.data(), data, size) == 0);
  return 0;
}
