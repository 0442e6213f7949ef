// Pictures as bytes: PNG written by hand from the standard (ISO/IEC 15948, stored blocks of RFC 1951), and a JPEG of
// another program.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace cellmirror {

inline void put_u32_be(std::string& to, std::uint32_t value) {
  for (unsigned shift = 32; shift > 0; shift -= 8) to.push_back(static_cast<char>((value >> (shift - 8)) & 0xFFU));
}

inline std::uint32_t crc_of(std::string_view bytes) {
  std::uint32_t crc = 0xFFFF'FFFFU;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int i = 0; i < 8; ++i) crc = (crc & 1U) != 0 ? 0xEDB8'8320U ^ (crc >> 1U) : crc >> 1U;
  }
  return ~crc;
}

inline std::string png_chunk(const std::string& kind, const std::string& data) {
  std::string out;
  put_u32_be(out, static_cast<std::uint32_t>(data.size()));
  out += kind + data;
  put_u32_be(out, crc_of(kind + data));
  return out;
}

// `rgba`: width * height * 4 bytes, rows from the top; together below 65,535 bytes.
inline std::string png_of(std::uint32_t width, std::uint32_t height, const std::string& rgba) {
  std::string header;
  put_u32_be(header, width);
  put_u32_be(header, height);
  header += std::string("\x08\x06\x00\x00\x00", 5);  // 8 bits, red green blue alpha, not interlaced
  std::string rows;
  for (std::size_t at = 0; at < rgba.size(); at += std::size_t{4} * width)
    rows += '\0' + rgba.substr(at, std::size_t{4} * width);
  std::string packed = "\x78\x01\x01";  // zlib; one stored block, the last one
  for (const std::size_t length : {rows.size(), ~rows.size()})
    packed += {static_cast<char>(length & 0xFFU), static_cast<char>((length >> 8U) & 0xFFU)};
  packed += rows;
  std::uint32_t a = 1;
  std::uint32_t b = 0;
  for (const char byte : rows) {
    a = (a + static_cast<unsigned char>(byte)) % 65521;
    b = (b + a) % 65521;
  }
  put_u32_be(packed, (b << 16U) | a);
  return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", header) + png_chunk("IDAT", packed) + png_chunk("IEND", "");
}

// Two pixels wide: red, green; below blue, and white of which half can be seen.
inline std::string four_pixels() {
  return png_of(2, 2, std::string("\xff\0\0\xff\0\xff\0\xff\0\0\xff\xff\xff\xff\xff\x80", 16));
}

// 8 x 8 pixels of red, by FFmpeg's encoder.
inline std::string red_jpeg() {
  constexpr std::string_view kHex =
      "ffd8ffe000104a46494600010200000100010000ffdb004300080404040404050505050505060606060606060606060606060707"
      "0708080807070706060707080808080909090808080809090a0a0a0c0c0b0b0e0e0e111114ffc4004c0001010000000000000000"
      "00000000000000060101010000000000000000000000000000060710010000000000000000000000000000000011010000000000"
      "0000000000000000000000ffc00011080008000803012200021100031100ffda000c03010002110311003f008b00517f7fffd9";
  std::string out;
  const auto digit = [](char c) { return c <= '9' ? c - '0' : c - 'a' + 10; };
  for (std::size_t i = 0; i < kHex.size(); i += 2)
    out.push_back(static_cast<char>(16 * digit(kHex[i]) + digit(kHex[i + 1])));
  return out;
}

}  // namespace cellmirror
