// The server of SDO transfers of one node: expedited and segmented; block transfers are refused with the abort code
// that makes a client fall back. No I/O, no clock.
#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <optional>
#include <span>
#include <vector>

#include "drivers/can/canopen/object_dictionary.hpp"
#include "drivers/can/canopen/sdo.hpp"

namespace cellmirror::can {

// The objects behind a server. Values are little-endian bytes.
class SdoObjects {
 public:
  virtual ~SdoObjects() = default;
  [[nodiscard]] virtual std::expected<std::vector<std::uint8_t>, SdoAbort> read(ObjectAddress address) = 0;
  // Nothing, or why not. `value` has 1..kMaxSdoValue bytes.
  [[nodiscard]] virtual std::optional<SdoAbort> write(ObjectAddress address, std::span<const std::uint8_t> value) = 0;
};

// read() and write() of a dictionary by its types, access and limits.
[[nodiscard]] std::expected<std::vector<std::uint8_t>, SdoAbort> read_object(const ObjectDictionary& objects,
                                                                             ObjectAddress address);
// What a write of `value` would be answered with; nothing is written.
[[nodiscard]] std::optional<SdoAbort> check_write(const ObjectDictionary& objects, ObjectAddress address,
                                                  std::span<const std::uint8_t> value);
[[nodiscard]] std::optional<SdoAbort> write_object(ObjectDictionary& objects, ObjectAddress address,
                                                   std::span<const std::uint8_t> value);

class SdoServer {
 public:
  // `node` 1..127; `objects` outlives the server.
  SdoServer(std::uint8_t node, SdoObjects& objects);

  // The answer to a request; none for frames of other services and for aborts.
  [[nodiscard]] std::optional<CanFrame> receive(const CanFrame& frame);
  // Forgets a transfer under way (NMT reset, stop).
  void reset() { transfer_ = Transfer::none; }

 private:
  enum class Transfer : std::uint8_t { none, download, upload };

  [[nodiscard]] CanFrame start_download(const CanFrame& frame);
  [[nodiscard]] CanFrame download_segment(const CanFrame& frame);
  [[nodiscard]] CanFrame start_upload(const CanFrame& frame);
  [[nodiscard]] CanFrame upload_segment(const CanFrame& frame);
  [[nodiscard]] CanFrame answer(unsigned command, ObjectAddress address) const;
  [[nodiscard]] CanFrame refuse(ObjectAddress address, SdoAbort abort);

  std::uint8_t node_;
  SdoObjects* objects_;
  Transfer transfer_ = Transfer::none;
  ObjectAddress address_;
  std::vector<std::uint8_t> value_;
  std::size_t announced_ = 0;
  std::size_t sent_ = 0;
  bool toggle_ = false;
};

}  // namespace cellmirror::can
