// Who asks a service, and what a reply to them looks like.
#include "drivers/dds/service_mapping.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "drivers/dds/controller_messages.hpp"
#include "drivers/dds/held_replies.hpp"
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

TEST(ServiceMapping, AReplyToNobodyIsOneOfEachService) {
  std::vector<std::byte> reply;
  write_reply_to_nobody(reply);
  EXPECT_EQ(reply, bytes({
                       0x00, 0x01, 0x00, 0x00,                          //
                       0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,  // no client's number
                       0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,  //
                       0x00, 0x00, 0x00, 0x00,                          // refused; code; status
                       0x00, 0x00, 0x00, 0x00,                          // stamp; no goals; error_code
                       0x01, 0x00, 0x00, 0x00, 0x00,                    // stamp; ; text
                   }));
}

TEST(ServiceMapping, UserDataNamesAClient) {
  EXPECT_EQ(client_id("clientid= 1.10.ab;"), " 1.10.ab");
  EXPECT_EQ(client_id("clientid=1"), "1");
  EXPECT_EQ(client_id("typehash=RIHS01_0;clientid=2;"), "2");
  EXPECT_EQ(client_id("a=;clientid=;"), "");
  EXPECT_EQ(client_id("clientid=" + std::string(100, 'x'))->size(), kMostClientId);
  for (const char* no :
       {"", ";", "clientid", "clientid;", "serviceid=1;", "typehash=clientid=1;", "xclientid=1;", "Clientid=1;"})
    EXPECT_FALSE(client_id(no).has_value()) << no;
}

Guid endpoint(std::size_t number, std::uint8_t kind) {
  Guid out{static_cast<std::uint8_t>(number), static_cast<std::uint8_t>(number >> 8U)};
  out.back() = kind;
  return out;
}
constexpr std::uint8_t kWriterKind = 0x03;
constexpr std::uint8_t kReaderKind = 0x04;

TEST(ServiceMapping, RemembersABoundedNumberOfClients) {
  ClientEndpoints sut;
  const Guid more = endpoint(ClientEndpoints::kMost, kWriterKind);
  const Guid third = endpoint(3, kWriterKind);
  for (std::size_t i = 0; i < ClientEndpoints::kMost; ++i) ASSERT_TRUE(sut.note(endpoint(i, kWriterKind), "1"));
  EXPECT_FALSE(sut.note(more, "1"));
  EXPECT_FALSE(sut.contains(more));
  EXPECT_TRUE(sut.note(third, "2")) << "known already";
  EXPECT_TRUE(sut.note(third, std::nullopt)) << "it has left, or announces none any more";
  EXPECT_FALSE(sut.contains(third));
  EXPECT_TRUE(sut.note(more, "1"));
  EXPECT_TRUE(sut.contains(more));
}

TEST(ServiceMapping, AReplyReachesTheReaderOfTheSameClient) {
  const Guid writer = endpoint(1, kWriterKind);
  const Guid own = endpoint(2, kReaderKind);
  const Guid foreign = endpoint(3, kReaderKind);
  const RequestName to{{writer, 1}, RequestHeader{5, 1}};
  ClientEndpoints sut;
  EXPECT_FALSE(sut.reaches(to, std::vector{own}));
  sut.note(writer, "a");
  sut.note(own, "a");
  sut.note(foreign, "b");
  EXPECT_TRUE(sut.reaches(to, std::vector{foreign, own}));
  EXPECT_FALSE(sut.reaches(to, std::vector{foreign}));
  EXPECT_FALSE(sut.reaches(to, {}));
  sut.note(writer, std::nullopt);
  EXPECT_FALSE(sut.reaches(to, std::vector{own}));
}

TEST(ServiceMapping, AReplyWithoutAHeaderReachesTheReaderThatTheRequestNames) {
  const Guid own = endpoint(2, kReaderKind);
  const ClientEndpoints sut;
  EXPECT_TRUE(sut.reaches({{own, 1}}, std::vector{endpoint(3, kReaderKind), own}));
  EXPECT_FALSE(sut.reaches({{own, 1}}, std::vector{endpoint(3, kReaderKind)}));
  EXPECT_TRUE(sut.reaches({{endpoint(1, kWriterKind), 1}}, {})) << "who names none: nobody knows";
}

TEST(HeldReplies, GoWhenTheyReachWhoAskedInTheirOrder) {
  HeldReplies sut;
  const auto to = [](std::int64_t number) { return RequestName{{{}, number}}; };
  for (std::int64_t i = 1; i <= 4; ++i) EXPECT_TRUE(sut.hold(to(i), bytes({static_cast<int>(i)})));
  EXPECT_TRUE(sut.take([](const RequestName&) { return false; }).empty());
  const auto even = sut.take([](const RequestName& name) { return name.sample.number % 2 == 0; });
  ASSERT_EQ(even.size(), 2U);
  EXPECT_EQ(even[0].to, to(2));
  EXPECT_EQ(even[1].payload, bytes({4}));
  EXPECT_EQ(sut.take([](const RequestName&) { return true; }).size(), 2U);
  EXPECT_TRUE(sut.take([](const RequestName&) { return true; }).empty());
}

TEST(HeldReplies, TheOldestIsDroppedForANewOne) {
  HeldReplies sut;
  for (std::size_t i = 0; i < HeldReplies::kMost; ++i) EXPECT_TRUE(sut.hold({{{}, static_cast<std::int64_t>(i)}}, {}));
  EXPECT_FALSE(sut.hold({{{}, 100}}, {}));
  const auto all = sut.take([](const RequestName&) { return true; });
  ASSERT_EQ(all.size(), HeldReplies::kMost);
  EXPECT_EQ(all.front().to.sample.number, 1);
  EXPECT_EQ(all.back().to.sample.number, 100);
}

}  // namespace
}  // namespace cellmirror::dds
