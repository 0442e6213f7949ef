// The records of MCAP files as plain data (MCAP specification, version 0: mcap.dev/spec), and the bounds that this
// project sets. Times are nanoseconds since 1970 (UTC), offsets are bytes from the start of the file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace cellmirror::mcap {

using Bytes = std::vector<std::byte>;
using View = std::span<const std::byte>;

// At the start and at the end of every file ("MCAP0" between bytes that text transfers would change).
inline constexpr std::array<std::uint8_t, 8> kMagic = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
inline constexpr std::size_t kRecordHead = 9;  // bytes: opcode and length
inline constexpr std::size_t kMessageHead = kRecordHead + 22;

enum class Opcode : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  attachment = 0x09,
  attachment_index = 0x0A,
  statistics = 0x0B,
  metadata = 0x0C,
  metadata_index = 0x0D,
  summary_offset = 0x0E,
  data_end = 0x0F,
};

enum class Compression : std::uint8_t { none, lz4, zstd };
// As in the file: "", "lz4", "zstd".
[[nodiscard]] std::string_view word(Compression compression);

using Texts = std::map<std::string, std::string, std::less<>>;

struct Header {
  std::string profile;  // "ros2"
  std::string library;
};

struct Footer {
  std::uint64_t summary_start = 0;         // 0: there is no summary
  std::uint64_t summary_offset_start = 0;  // 0: there are no summary offsets
  std::uint32_t summary_crc = 0;           // 0: not given
};

struct Schema {
  std::uint16_t id = 0;  // 1..65535
  std::string name;
  std::string encoding;  // "ros2msg", "jsonschema"
  std::string data;

  friend bool operator==(const Schema&, const Schema&) = default;
};

struct Channel {
  std::uint16_t id = 0;
  std::uint16_t schema = 0;  // 0: none
  std::string topic;
  std::string encoding;  // of messages: "cdr", "json"
  Texts metadata = {};

  friend bool operator==(const Channel&, const Channel&) = default;
};

struct Message {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;      // 0 where none is known
  std::uint64_t log_time = 0;      // when it was recorded
  std::uint64_t publish_time = 0;  // when it was made
  View data = {};
};

struct Chunk {
  std::uint64_t start_time = 0;  // least log time; 0 without messages
  std::uint64_t end_time = 0;
  std::uint64_t uncompressed_size = 0;
  std::uint32_t uncompressed_crc = 0;  // 0: not given
  std::string compression = {};
  View records = {};
};

// Of one channel in the chunk before it: log time, and offset in the uncompressed records.
struct MessageIndex {
  std::uint16_t channel = 0;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> entries;
};

struct ChunkIndex {
  std::uint64_t start_time = 0;
  std::uint64_t end_time = 0;
  std::uint64_t offset = 0;
  std::uint64_t length = 0;  // of the record, its head included
  std::map<std::uint16_t, std::uint64_t> message_index_offsets;
  std::uint64_t message_index_length = 0;
  std::string compression;
  std::uint64_t compressed_size = 0;
  std::uint64_t uncompressed_size = 0;
};

struct Attachment {
  std::uint64_t log_time = 0;
  std::uint64_t create_time = 0;
  std::string name = {};
  std::string media_type = {};
  View data = {};
};

struct AttachmentIndex {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::uint64_t log_time = 0;
  std::uint64_t create_time = 0;
  std::uint64_t data_size = 0;
  std::string name;
  std::string media_type;
};

struct Statistics {
  std::uint64_t messages = 0;
  std::uint16_t schemas = 0;
  std::uint32_t channels = 0;
  std::uint32_t attachments = 0;
  std::uint32_t metadata = 0;
  std::uint32_t chunks = 0;
  std::uint64_t start_time = 0;
  std::uint64_t end_time = 0;
  std::map<std::uint16_t, std::uint64_t> channel_messages;

  void count(const Message& message);
  friend bool operator==(const Statistics&, const Statistics&) = default;
};

struct Metadata {
  std::string name;
  Texts values;
};

struct MetadataIndex {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::string name;
};

struct SummaryOffset {
  std::uint8_t opcode = 0;
  std::uint64_t start = 0;
  std::uint64_t length = 0;
};

// CRC-32 (ISO-HDLC, that of zlib) of `data` behind what `before` is the CRC of.
[[nodiscard]] std::uint32_t crc32(View data, std::uint32_t before = 0);

[[nodiscard]] inline View view_of(std::string_view text) { return std::as_bytes(std::span(text.data(), text.size())); }

}  // namespace cellmirror::mcap
