#include "ipc/sandbox/message_bytes.hpp"

#include <gtest/gtest.h>

#include "drivers/dds/message/dds_message.hpp"

namespace cellmirror::dds {
namespace {

std::vector<std::byte> encoded(DdsEvent event) {
  std::vector<std::byte> out;
  encode(event, out);
  return out;
}

TEST(MessageBytes, BringsEveryFieldAcross) {
  DdsRequest sent = OpenParticipant{.domain = 7,
                                    .address = "127.0.0.1",
                                    .security = {.identity_ca = "/a",
                                                 .certificate = "/b",
                                                 .private_key = "/c",
                                                 .permissions_ca = "/d",
                                                 .governance = "/e",
                                                 .permissions = "/f"},
                                    .network = {.discovery_servers = {{"10.0.0.1", 11811, 3}},
                                                .peers = {{"10.0.0.2", 0}, {"10.0.0.3", 7410}},
                                                .multicast = false,
                                                .link = DdsLink::lossy}};
  std::vector<std::byte> bytes;
  encode(sent, bytes);
  const auto received = decode_request(bytes);
  ASSERT_TRUE(received.has_value());
  const auto& got = std::get<OpenParticipant>(received->message);
  const auto& put = std::get<OpenParticipant>(sent);
  EXPECT_EQ(got.domain, put.domain);
  EXPECT_EQ(got.address, put.address);
  EXPECT_EQ(got.security, put.security);
  EXPECT_EQ(got.network, put.network);
}

TEST(MessageBytes, GivesTheBytesOfASampleBehindItsFields) {
  auto bytes = encoded(SampleReceived{.id = 3, .number = 9});
  bytes.push_back(std::byte{42});
  const auto received = decode_event(bytes);
  ASSERT_TRUE(received.has_value());
  EXPECT_EQ(std::get<SampleReceived>(received->message).number, 9);
  ASSERT_EQ(received->rest.size(), 1U);
  EXPECT_EQ(received->rest.front(), std::byte{42});
}

TEST(MessageBytes, RefusesEveryTruncation) {
  const auto whole = encoded(LibraryLog{true, "category", "text"});
  for (std::size_t size = 0; size < whole.size(); ++size)
    ASSERT_FALSE(decode_event(std::span(whole).first(size)).has_value()) << size;
}

TEST(MessageBytes, RefusesBytesThatAreLeftOver) {
  auto bytes = encoded(SamplesDropped{1, 2});
  bytes.push_back(std::byte{0});
  EXPECT_FALSE(decode_event(bytes).has_value());
}

TEST(MessageBytes, RefusesAnUnknownKind) {
  for (int kind = std::variant_size_v<DdsEvent>; kind < 256; ++kind) {
    std::vector<std::byte> bytes(64);
    bytes[0] = static_cast<std::byte>(kind);
    ASSERT_FALSE(decode_event(bytes).has_value()) << kind;
  }
}

TEST(MessageBytes, RefusesALengthBeyondTheMessage) {
  auto bytes = encoded(EndpointRefused{1, "why"});
  bytes[1 + sizeof(std::uint32_t)] = std::byte{255};  // of the text
  EXPECT_FALSE(decode_event(bytes).has_value());
}

}  // namespace
}  // namespace cellmirror::dds
