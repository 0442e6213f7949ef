// The server of SDO transfers of one node: expedited, segmented and block transfers. No I/O, no clock.
#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <optional>
#include <span>
#include <vector>

#include "drivers/can/canopen/object_dictionary.hpp"
#include "drivers/can/canopen/sdo.hpp"
#include "drivers/can/canopen/sdo_block.hpp"
#include "rt_core/base/time.hpp"

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
  // A transfer whose client is silent for this long is aborted (0x05040000).
  static constexpr Nanoseconds kTimeout{1'000'000'000};

  // `node` 1..127; `objects` outlives the server.
  SdoServer(std::uint8_t node, SdoObjects& objects);

  // The answer to a request; none for frames of other services and for aborts.
  [[nodiscard]] std::optional<CanFrame> receive(const CanFrame& frame, Timestamp now);
  // The next frame that is due without a request: a segment of a block upload, or the abort of a transfer that timed
  // out. Call it until there is none, after receive() and at next_due().
  [[nodiscard]] std::optional<CanFrame> advance(Timestamp now);
  // "Never" without a transfer.
  [[nodiscard]] Timestamp next_due() const;
  // Forgets a transfer under way (NMT reset, stop).
  void reset() { transfer_ = Transfer::none; }
  // 1..127, from the next request on.
  void set_node(std::uint8_t node) { node_ = node; }

 private:
  enum class Transfer : std::uint8_t {
    none,
    download,
    upload,
    block_download,      // segments come
    block_download_end,  // all segments are there
    block_upload_start,  // the client has not said "start" yet
    block_upload,        // segments go
    block_upload_end,    // the client has not confirmed the end yet
  };

  [[nodiscard]] std::optional<CanFrame> answer_request(const CanFrame& frame);
  [[nodiscard]] CanFrame start_download(const CanFrame& frame);
  [[nodiscard]] CanFrame download_segment(const CanFrame& frame);
  [[nodiscard]] CanFrame start_upload(const CanFrame& frame);
  [[nodiscard]] CanFrame upload_segment(const CanFrame& frame);
  [[nodiscard]] CanFrame start_block_download(const CanFrame& frame);
  [[nodiscard]] std::optional<CanFrame> block_download_segment(const CanFrame& frame);
  [[nodiscard]] CanFrame end_block_download(const CanFrame& frame);
  [[nodiscard]] std::optional<CanFrame> block_upload(const CanFrame& frame);
  [[nodiscard]] CanFrame start_block_upload(const CanFrame& frame);
  [[nodiscard]] std::optional<CanFrame> block_upload_acknowledged(const CanFrame& frame);
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
  SdoBlockDownload block_download_;
  SdoBlockUpload block_upload_;
  Timestamp deadline_;   // of the client's next request
  Timestamp burst_due_;  // when more segments of a block upload may go
  int burst_ = 0;        // segments sent since
};

}  // namespace cellmirror::can
