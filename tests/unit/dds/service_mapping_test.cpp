// Who asks a service, and what a reply to them looks like.
#include "drivers/dds/service_mapping.hpp"

#include <gtest/gtest.h>

#include "drivers/dds/controller_messages.hpp"
#include "tests/unit/dds/golden.hpp"

namespace cellmirror::dds {
namespace {

using test::bytes;

const SampleName kSample{{1, 2, 3}, 7};
const Guid kReader{9, 9, 9};

// A request for a result: client 0x1122334455667788, number 5, the goal's id.
const std::vector<std::byte> kWithHeader = bytes({
    0x00, 0x01, 0x00, 0x00,                          // CDR_LE
    0x88, 0x77, 0x66, 0x55, 0x44, 0x33, 0x22, 0x11,  // the client
    0x05, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,  // its number
    0xA0, 0xA1, 0xA2, 0xA3, 0xA4, 0xA5, 0xA6, 0xA7, 0xA8, 0xA9, 0xAA, 0xAB, 0xAC, 0xAD, 0xAE, 0xAF,
});

RequestSample with_header() { return {.payload = kWithHeader, .name = kSample, .announces_client = true}; }

std::vector<std::byte> goal_reply(const RequestName& to) {
  std::vector<std::byte> payload;
  CdrWriter out(payload);
  begin_reply(to, out);
  write_goal_reply(true, {3, 4}, out);
  end_reply(out);
  return payload;
}

TEST(ServiceMapping, AHeaderInFrontNamesTheClientAndItsRequest) {
  const auto request = open_request(with_header());
  ASSERT_TRUE(request.has_value());
  EXPECT_EQ(request->name, (RequestName{kSample, RequestHeader{0x1122334455667788U, 5}}));
  GoalId id{};
  ASSERT_EQ(decode(request->content, id), CdrFault::none);
  EXPECT_EQ(id[0], 0xA0);
  EXPECT_EQ(id[15], 0xAF);
}

TEST(ServiceMapping, AHeaderMayBeBigEndian) {
  std::vector<std::byte> payload = kWithHeader;
  payload[1] = std::byte{0};
  const auto request = open_request({.payload = payload, .name = kSample, .related = {}, .announces_client = true});
  ASSERT_TRUE(request.has_value());
  EXPECT_EQ(request->name.header, (RequestHeader{0x8877665544332211U, 0x0500000000000000}));
}

TEST(ServiceMapping, NobodyIsAnsweredWhereTheHeaderIsCut) {
  RequestSample sample = with_header();
  for (std::size_t size = 0; size < 20; ++size) {
    sample.payload = std::span(kWithHeader).first(size);
    EXPECT_FALSE(open_request(sample).has_value()) << size;
  }
  for (std::size_t size = 20; size < kWithHeader.size(); ++size) {
    sample.payload = std::span(kWithHeader).first(size);
    const auto request = open_request(sample);
    ASSERT_TRUE(request.has_value()) << size;
    GoalId id{};
    EXPECT_EQ(decode(request->content, id), CdrFault::truncated) << size;
  }
}

TEST(ServiceMapping, WithoutAHeaderTheSampleNamesTheRequest) {
  RequestSample sample = with_header();
  sample.announces_client = false;
  auto request = open_request(sample);
  ASSERT_TRUE(request.has_value());
  EXPECT_EQ(request->name, RequestName{kSample});
  GoalId id{};
  ASSERT_EQ(decode(request->content, id), CdrFault::none);
  EXPECT_EQ(id[0], 0x88);
  // Who names a reader of replies in the inline QoS has no header, whatever else is announced.
  for (const bool announces : {false, true}) {
    sample.announces_client = announces;
    sample.related = kReader;
    request = open_request(sample);
    ASSERT_TRUE(request.has_value());
    EXPECT_EQ(request->name, (RequestName{{kReader, 7}}));
  }
}

TEST(ServiceMapping, AReplyRepeatsTheHeaderInFrontOfItsContent) {
  EXPECT_EQ(goal_reply(open_request(with_header())->name), bytes({
                                                               0x00, 0x01, 0x00, 0x00,                          //
                                                               0x88, 0x77, 0x66, 0x55, 0x44, 0x33, 0x22, 0x11,  //
                                                               0x05, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,  //
                                                               0x01, 0x00, 0x00, 0x00,  // accepted
                                                               0x03, 0x00, 0x00, 0x00, 0x04, 0x00, 0x00, 0x00,  // stamp
                                                           }));
}

TEST(ServiceMapping, AReplyWithoutAHeaderIsAsLongAsOneAndNoClientsOwn) {
  const std::vector<std::byte> reply = goal_reply({kSample});
  EXPECT_EQ(reply, bytes({
                       0x00, 0x01, 0x00, 0x00,                          //
                       0x01, 0x00, 0x00, 0x00,                          // accepted
                       0x03, 0x00, 0x00, 0x00, 0x04, 0x00, 0x00, 0x00,  // stamp
                       0x00, 0x00, 0x00, 0x00,
                   }));
}

TEST(ServiceMapping, UserDataOfAClientHasItsKey) {
  for (const char* yes : {"clientid= 1.10.ab;", "clientid=1", "typehash=RIHS01_0;clientid=1;", "a=;clientid=;"})
    EXPECT_TRUE(announces_client(yes)) << yes;
  for (const char* no :
       {"", ";", "clientid", "clientid;", "serviceid=1;", "typehash=clientid=1;", "xclientid=1;", "Clientid=1;"})
    EXPECT_FALSE(announces_client(no)) << no;
}

TEST(ServiceMapping, RemembersABoundedNumberOfClients) {
  ClientWriters sut;
  const auto writer = [](std::size_t number) {
    return Guid{static_cast<std::uint8_t>(number), static_cast<std::uint8_t>(number >> 8U)};
  };
  for (std::size_t i = 0; i < ClientWriters::kMost; ++i) ASSERT_TRUE(sut.note(writer(i), true));
  EXPECT_FALSE(sut.note(writer(ClientWriters::kMost), true));
  EXPECT_FALSE(sut.contains(writer(ClientWriters::kMost)));
  EXPECT_TRUE(sut.note(writer(3), true)) << "known already";
  EXPECT_TRUE(sut.note(writer(3), false)) << "it has left, or announces it no more";
  EXPECT_FALSE(sut.contains(writer(3)));
  EXPECT_TRUE(sut.note(writer(ClientWriters::kMost), true));
  EXPECT_TRUE(sut.contains(writer(ClientWriters::kMost)));
}

}  // namespace
}  // namespace cellmirror::dds
