// SENSOR records of every kind: whatever is accepted is written back byte for byte.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "ipc/wire/barrier_record.hpp"
#include "ipc/wire/camera_record.hpp"
#include "ipc/wire/proximity_record.hpp"
#include "ipc/wire/range_record.hpp"
#include "ipc/wire/robot_record.hpp"
#include "ipc/wire/tissue_record.hpp"
#include "rt_core/base/contract.hpp"

namespace {

using namespace cellmirror;

template <class Decode, class Encode>
void round_trip(std::span<const std::byte> bytes, Decode decode, Encode encode) {
  const auto record = decode(bytes);
  if (!record) {
    CELLMIRROR_EXPECTS(!record.error().what.empty());
    return;
  }
  std::array<std::byte, kMaxRecordBytes> again{};
  const auto length = encode(*record, again);
  CELLMIRROR_EXPECTS(length && *length == bytes.size());
  CELLMIRROR_EXPECTS(std::memcmp(again.data(), bytes.data(), bytes.size()) == 0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = std::as_bytes(std::span(data, size));
  round_trip(bytes, decode_robot_record, encode_robot_record);
  round_trip(bytes, decode_range_record, encode_range_record);
  round_trip(bytes, decode_range_array, encode_range_array);
  round_trip(bytes, decode_camera_record, encode_camera_record);
  round_trip(bytes, decode_proximity_record, encode_proximity_record);
  round_trip(bytes, decode_event_record, encode_event_record);
  round_trip(bytes, decode_tissue_record, encode_tissue_record);
  round_trip(bytes, decode_barrier_record, encode_barrier_record);
  return 0;
}
