// Contents of records of MCAP from bytes that anybody may have written. Pure. Each function takes the content of one
// record, without opcode and length; nothing where a length reaches beyond it. Bytes behind the known fields are
// ignored, as the specification demands. Texts and data that are views live as long as the content.
#pragma once

#include <concepts>
#include <optional>
#include <string>

#include "ipc/record/layout.hpp"

namespace cellmirror::mcap {

// The first fault sticks: from then on every value is zero or empty.
class Decoder {
 public:
  explicit Decoder(View in) : in_(in) {}

  template <std::unsigned_integral T>
  T number() {
    const View from = take(sizeof(T));
    T value = 0;
    for (std::size_t i = 0; i < from.size(); ++i)
      value = static_cast<T>(value | static_cast<T>(std::to_integer<T>(from[i]) << (8 * i)));
    return value;
  }
  View bytes(std::uint64_t size) { return take(size); }
  std::string text();
  Texts texts();
  // Of a map or array whose length in bytes comes first.
  Decoder part() { return Decoder(take(number<std::uint32_t>())); }
  // Number and number.
  std::map<std::uint16_t, std::uint64_t> numbers();

  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] bool at_end() const { return position_ == in_.size(); }
  [[nodiscard]] std::size_t position() const { return position_; }
  void refuse() { ok_ = false; }

 private:
  View take(std::uint64_t size);

  View in_;
  std::size_t position_ = 0;
  bool ok_ = true;
};

[[nodiscard]] std::optional<Header> decode_header(View content);
[[nodiscard]] std::optional<Footer> decode_footer(View content);
[[nodiscard]] std::optional<Schema> decode_schema(View content);  // not with the id 0
[[nodiscard]] std::optional<Channel> decode_channel(View content);
[[nodiscard]] std::optional<Message> decode_message(View content);
[[nodiscard]] std::optional<Chunk> decode_chunk(View content);
[[nodiscard]] std::optional<MessageIndex> decode_message_index(View content);
[[nodiscard]] std::optional<ChunkIndex> decode_chunk_index(View content);
// `crc_ok`: whether the CRC is right, or not given (0).
[[nodiscard]] std::optional<Attachment> decode_attachment(View content, bool& crc_ok);
[[nodiscard]] std::optional<AttachmentIndex> decode_attachment_index(View content);
[[nodiscard]] std::optional<Statistics> decode_statistics(View content);
[[nodiscard]] std::optional<Metadata> decode_metadata(View content);
[[nodiscard]] std::optional<MetadataIndex> decode_metadata_index(View content);
[[nodiscard]] std::optional<SummaryOffset> decode_summary_offset(View content);
[[nodiscard]] std::optional<std::uint32_t> decode_data_end(View content);

}  // namespace cellmirror::mcap
