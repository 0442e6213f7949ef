// Records of MCAP as bytes. Pure. Each function appends one whole record: opcode, length, content.
#pragma once

#include <concepts>
#include <cstring>
#include <string_view>

#include "ipc/record/layout.hpp"

namespace cellmirror::mcap {

// Little endian, behind what is already in `out`.
class Encoder {
 public:
  explicit Encoder(Bytes& out) : out_(out) {}

  template <std::unsigned_integral T>
  Encoder& number(T value) {
    std::array<std::byte, sizeof(T)> bytes;
    for (std::size_t i = 0; i < sizeof(T); ++i) bytes[i] = static_cast<std::byte>((value >> (8 * i)) & 0xFFU);
    out_.insert(out_.end(), bytes.begin(), bytes.end());
    return *this;
  }
  Encoder& bytes(View data) {
    out_.insert(out_.end(), data.begin(), data.end());
    return *this;
  }
  // With a length of 32 bits.
  Encoder& text(std::string_view text) { return number(static_cast<std::uint32_t>(text.size())).bytes(view_of(text)); }
  Encoder& texts(const Texts& texts);

  // Of a record; the length is entered by end().
  Encoder& begin(Opcode opcode);
  void end();

 private:
  Bytes& out_;
  std::size_t begun_ = 0;
};

void append_magic(Bytes& out);
void append(const Header& record, Bytes& out);
void append(const Footer& record, Bytes& out);
void append(const Schema& record, Bytes& out);
void append(const Channel& record, Bytes& out);
void append(const Message& record, Bytes& out);
void append(const Chunk& record, Bytes& out);
void append(const MessageIndex& record, Bytes& out);
void append(const ChunkIndex& record, Bytes& out);
// With the CRC over its content before it.
void append(const Attachment& record, Bytes& out);
void append(const AttachmentIndex& record, Bytes& out);
void append(const Statistics& record, Bytes& out);
void append(const Metadata& record, Bytes& out);
void append(const MetadataIndex& record, Bytes& out);
void append(const SummaryOffset& record, Bytes& out);
void append_data_end(std::uint32_t data_section_crc, Bytes& out);

}  // namespace cellmirror::mcap
