#include "ipc/web/websocket.hpp"

#include <gtest/gtest.h>

#include <string>

#include "ipc/web/sha1.hpp"

namespace cellmirror::web {
namespace {

using namespace std::string_literals;

std::string hexadecimal(const std::string& text) {
  std::string out;
  for (const std::uint8_t byte : sha1(text)) {
    out += "0123456789abcdef"[byte >> 4U];
    out += "0123456789abcdef"[byte & 15U];
  }
  return out;
}

// The examples of FIPS 180 (NIST's "SHA-1 examples").
TEST(Sha1, GivesThePublishedDigests) {
  EXPECT_EQ(hexadecimal("abc"), "a9993e364706816aba3e25717850c26c9cd0d89d");
  EXPECT_EQ(hexadecimal("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "84983e441c3bd26ebaae4aa1f95129e5e54670f1");
  EXPECT_EQ(hexadecimal(""), "da39a3ee5e6b4b0d3255bfef95601890afd80709");
}

// RFC 6455, section 1.3.
TEST(WebSocketOpening, AnswersTheKeyOfTheStandardsExample) {
  HttpRequest request;
  request.method = "GET";
  request.headers = {{"upgrade", "websocket"},
                     {"connection", "Upgrade"},
                     {"sec-websocket-key", "dGhlIHNhbXBsZSBub25jZQ=="},
                     {"sec-websocket-version", "13"}};
  EXPECT_EQ(websocket_accept(request), "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");
  request.headers[3].second = "8";
  EXPECT_FALSE(websocket_accept(request)) << "another version";
  request.headers[3].second = "13";
  request.headers[0].second = "h2c";
  EXPECT_FALSE(websocket_accept(request)) << "another protocol";
}

// RFC 6455, section 5.7: a masked "Hello".
const std::string kMaskedHello = "\x81\x85\x37\xfa\x21\x3d\x7f\x9f\x4d\x51\x58"s;
// The same masking key, the text in two parts with a ping between them.
const std::string kParts =
    "\x01\x83\x00\x00\x00\x00Hel"s + "\x89\x81\x00\x00\x00\x00p"s + "\x80\x82\x00\x00\x00\x00lo"s;

TEST(FrameReader, UnmasksTheStandardsExample) {
  FrameReader sut(100);
  sut.push(kMaskedHello);
  const auto message = sut.next();
  ASSERT_TRUE(message);
  EXPECT_EQ(message->opcode, Opcode::text);
  EXPECT_EQ(message->payload, "Hello");
  EXPECT_FALSE(sut.next());
  EXPECT_FALSE(sut.error());
}

TEST(FrameReader, TakesBytesOneByOne) {
  FrameReader sut(100);
  for (std::size_t i = 0; i < kMaskedHello.size(); ++i) {
    EXPECT_FALSE(sut.next());
    sut.push(kMaskedHello.substr(i, 1));
  }
  EXPECT_EQ(sut.next()->payload, "Hello");
}

TEST(FrameReader, JoinsPartsAroundAPing) {
  FrameReader sut(100);
  sut.push(kParts);
  const auto ping = sut.next();
  ASSERT_TRUE(ping);
  EXPECT_EQ(ping->opcode, Opcode::ping);
  const auto message = sut.next();
  ASSERT_TRUE(message);
  EXPECT_EQ(message->payload, "Hello");
}

TEST(FrameReader, CountsPartsThatAreEmpty) {
  FrameReader sut(100);
  sut.push("\x01\x80\x00\x00\x00\x00"s);
  for (int i = 0; i < 50; ++i) sut.push("\x00\x80\x00\x00\x00\x00"s);
  EXPECT_FALSE(sut.next());
  EXPECT_EQ(sut.take_count(), 51u);
  EXPECT_EQ(sut.take_count(), 0u);
  sut.push(kParts.substr(kParts.size() - 8));
  EXPECT_EQ(sut.next().value_or(WebSocketMessage{}).payload, "lo");
  EXPECT_EQ(sut.take_count(), 1u);
}

void expect_error(const std::string& bytes, CloseCode code) {
  FrameReader sut(100);
  sut.push(bytes);
  EXPECT_FALSE(sut.next());
  ASSERT_TRUE(sut.error());
  EXPECT_EQ(*sut.error(), code);
  sut.push(kMaskedHello);
  EXPECT_FALSE(sut.next()) << "nothing is taken after an error";
}

TEST(FrameReader, RefusesWhatTheStandardForbids) {
  expect_error("\x81\x05Hello"s, CloseCode::protocol_error);                     // not masked
  expect_error("\xC1\x80\x00\x00\x00\x00"s, CloseCode::protocol_error);          // a reserved bit
  expect_error("\x83\x80\x00\x00\x00\x00"s, CloseCode::protocol_error);          // an unknown opcode
  expect_error("\x09\x80\x00\x00\x00\x00"s, CloseCode::protocol_error);          // a ping in parts
  expect_error("\x89\xFE\x01\x00\x00\x00\x00\x00"s, CloseCode::protocol_error);  // a ping of 256 bytes
  expect_error("\x80\x80\x00\x00\x00\x00"s, CloseCode::protocol_error);          // goes on with nothing
}

// Sections 8.1 and 7.4.
TEST(FrameReader, RefusesTextThatIsNoneAndCodesThatNobodyMaySend) {
  for (const std::string& text : {"\xFF\xFE"s, "\xC0\xAF"s, "\xED\xA0\x80"s, "\xF4\x90\x80\x80"s, "\xE2\x82"s})
    expect_error("\x81"s + static_cast<char>(0x80 | text.size()) + "\0\0\0\0"s + text, CloseCode::bad_text);
  expect_error("\x88\x81\0\0\0\0\x03"s, CloseCode::protocol_error);      // half a code
  expect_error("\x88\x82\0\0\0\0\x03\xED"s, CloseCode::protocol_error);  // 1005
  expect_error("\x88\x82\0\0\0\0\x00\x01"s, CloseCode::protocol_error);  // 1
  expect_error("\x88\x83\0\0\0\0\x03\xE8\xFF"s, CloseCode::bad_text);    // the reason
  FrameReader sut(100);
  sut.push("\x81\x89\0\0\0\0\xC3\xA4\xE2\x82\xAC\xF0\x9F\x98\x80"s + "\x88\x80\0\0\0\0"s + "\x88\x82\0\0\0\0\x0F\xA1"s);
  EXPECT_EQ(sut.next().value_or(WebSocketMessage{}).payload, "\xC3\xA4\xE2\x82\xAC\xF0\x9F\x98\x80")
      << "two to four bytes";
  EXPECT_EQ(close_code_of(sut.next().value_or(WebSocketMessage{}).payload), CloseCode::none_given);
  EXPECT_EQ(static_cast<int>(close_code_of(sut.next().value_or(WebSocketMessage{}).payload)), 4001);
}

TEST(FrameReader, RefusesALongFrameByItsHeader) {
  expect_error("\x81\xFE\x00\x65"s, CloseCode::too_big);  // 101 bytes; the header alone
  expect_error("\x81\xFF\x7F\xFF\xFF\xFF\xFF\xFF\xFF\xFF"s, CloseCode::too_big);
  expect_error("\x81\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF"s, CloseCode::too_big);
}

TEST(FrameReader, BoundsAMessageOfManyParts) {
  FrameReader sut(100);
  sut.push("\x01\xBC\x00\x00\x00\x00"s + std::string(60, 'a'));
  EXPECT_FALSE(sut.next());
  EXPECT_FALSE(sut.error());
  sut.push("\x00\xBC\x00\x00\x00\x00"s + std::string(60, 'a'));
  EXPECT_FALSE(sut.next());
  EXPECT_EQ(sut.error(), CloseCode::too_big);
}

// RFC 6455, section 5.2: lengths in 7, 16 and 64 bits.
TEST(FrameHeader, SaysTheLengthAsShortAsPossible) {
  EXPECT_EQ(frame(Opcode::text, "Hello"), "\x81\x05Hello");
  EXPECT_EQ(frame_header(Opcode::binary, 125), "\x82\x7D"s);
  EXPECT_EQ(frame_header(Opcode::binary, 126), "\x82\x7E\x00\x7E"s);
  EXPECT_EQ(frame_header(Opcode::binary, 65536), "\x82\x7F\x00\x00\x00\x00\x00\x01\x00\x00"s);
  EXPECT_EQ(close_frame(CloseCode::policy, "no"), "\x88\x04\x03\xF0no"s);
  EXPECT_EQ(close_frame(CloseCode::none_given, "no"), "\x88\x00"s);
}

}  // namespace
}  // namespace cellmirror::web
