// Messages of clients as they are read, and those of the server to the byte, by the written protocol.
#include <gtest/gtest.h>

#include <string>
#include <variant>

#include "ipc/foxglove/client_message.hpp"
#include "ipc/foxglove/server_message.hpp"

namespace cellmirror::foxglove {
namespace {

using namespace std::string_literals;

template <class Message>
Message read(std::string_view text) {
  const auto message = read_text_message(text);
  EXPECT_TRUE(message) << message.error();
  const Message* found = message ? std::get_if<Message>(&*message) : nullptr;
  EXPECT_NE(found, nullptr) << text;
  return found == nullptr ? Message() : *found;
}

TEST(FoxgloveClientMessage, IsRead) {
  const auto subscribe =
      read<Subscribe>(R"({"op":"subscribe","subscriptions":[{"id":0,"channelId":3},{"id":4294967295,"channelId":5}]})");
  ASSERT_EQ(subscribe.subscriptions.size(), 2U);
  EXPECT_EQ(subscribe.subscriptions[1].id, 4294967295U);
  EXPECT_EQ(subscribe.subscriptions[1].channel, 5U);
  EXPECT_EQ(read<Unsubscribe>(R"({"op":"unsubscribe","subscriptionIds":[0,1]})").subscriptions.size(), 2U);
  const auto get = read<GetParameters>(R"({"op":"getParameters","parameterNames":["/a"],"id":"request"})");
  EXPECT_EQ(get.names, std::vector<std::string>{"/a"});
  EXPECT_EQ(get.request, "request");
  EXPECT_FALSE(read<GetParameters>(R"({"op":"getParameters","parameterNames":[]})").request);
  const auto set = read<SetParameters>(
      R"({"op":"setParameters","parameters":[{"name":"a","value":2},{"name":"b","value":true},{"name":"c","value":"t"},{"name":"d"}]})");
  ASSERT_EQ(set.parameters.size(), 4U);
  EXPECT_EQ(std::get<double>(set.parameters[0].value), 2.0);
  EXPECT_TRUE(std::get<bool>(set.parameters[1].value));
  EXPECT_EQ(std::get<std::string>(set.parameters[2].value), "t");
  EXPECT_TRUE(std::holds_alternative<std::monostate>(set.parameters[3].value));
  EXPECT_EQ(read<SubscribeParameters>(R"({"op":"subscribeParameterUpdates","parameterNames":["/a"]})").names.size(),
            1U);
  EXPECT_TRUE(read<UnsubscribeParameters>(R"({"op":"unsubscribeParameterUpdates","parameterNames":[]})").names.empty());
  const auto fetch = read<FetchAsset>(R"({"op":"fetchAsset","uri":"package://cell/a.stl","requestId":123})");
  EXPECT_EQ(fetch.uri, "package://cell/a.stl");
  EXPECT_EQ(fetch.request, 123U);
}

TEST(FoxgloveClientMessage, OfWhatIsNotOfferedOrMalformedIsRefused) {
  for (const std::string& text : {""s,
                                  "null"s,
                                  "[]"s,
                                  "{"s,
                                  R"({"op":7})"s,
                                  R"({"op":"clientPublish"})"s,
                                  R"({"op":"advertise","channels":[]})"s,
                                  R"({"op":"subscribeConnectionGraph"})"s,
                                  R"({"op":"subscribe"})"s,
                                  R"({"op":"subscribe","subscriptions":{}})"s,
                                  R"({"op":"subscribe","subscriptions":[7]})"s,
                                  R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]})"s,
                                  R"({"op":"subscribe","subscriptions":[{"id":1.5,"channelId":1}]})"s,
                                  R"({"op":"subscribe","subscriptions":[{"id":4294967296,"channelId":1}]})"s,
                                  R"({"op":"getParameters","parameterNames":[7]})"s,
                                  R"({"op":"getParameters","parameterNames":[],"id":7})"s,
                                  R"({"op":"setParameters","parameters":[{"value":7}]})"s,
                                  R"({"op":"setParameters","parameters":[{"name":"a","value":[7]}]})"s,
                                  R"({"op":"fetchAsset","uri":"a"})"s,
                                  R"({"op":"fetchAsset","requestId":1})"s,
                                  R"({"op":"fetchAsset","uri":")"s + std::string(2000, 'u') + R"(","requestId":1})"}) {
    const auto message = read_text_message(text);
    EXPECT_FALSE(message) << text;
    EXPECT_TRUE(message || !message.error().empty());
  }
}

TEST(FoxgloveClientMessage, ACallOfAServiceIsBinary) {
  const auto message = read_binary_message("\x02\x01\0\0\0\x07\x01\0\0\x04\0\0\0json{}"s);
  ASSERT_TRUE(message);
  const auto& call = std::get<CallService>(*message);
  EXPECT_EQ(call.service, 1U);
  EXPECT_EQ(call.call, 263U);
  EXPECT_EQ(call.encoding, "json");
  EXPECT_EQ(call.payload, "{}");
  for (const std::string& bytes : {""s, "\x01"s, "\x02"s, "\x02\x01\0\0\0\x07\x01\0\0\x05\0\0\0json"s, "\x63zzz"s,
                                   "\x02\x01\0\0\0\x07\x01\0\0\xFF\xFF\xFF\xFFjson"s})
    EXPECT_FALSE(read_binary_message(bytes));
}

TEST(FoxgloveClientMessage, PlaybackControlIsBinary) {
  const auto with_seek = read_binary_message("\x03\x01\0\0\xC0\x3F\x01\x18\x17\x16\x15\x14\x13\x12\x11\x02\0\0\0id"s);
  ASSERT_TRUE(with_seek) << with_seek.error();
  const auto& control = std::get<PlaybackControl>(*with_seek);
  EXPECT_FALSE(control.play);
  EXPECT_EQ(control.speed, 1.5);
  EXPECT_EQ(control.seek_ns, 0x1112131415161718U);
  EXPECT_EQ(control.request, "id");
  const auto without = read_binary_message("\x03\0\0\0\x80\x3F\0\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\0\0\0\0"s);
  ASSERT_TRUE(without) << without.error();
  EXPECT_TRUE(std::get<PlaybackControl>(*without).play);
  EXPECT_FALSE(std::get<PlaybackControl>(*without).seek_ns);
  const std::string head = "\x03\0\0\0\x80\x3F\0\0\0\0\0\0\0\0\0"s;
  for (const std::string& bytes :
       {"\x03"s, head, head + "\x03\0\0\0id"s, head + "\xFF\xFF\xFF\xFFid"s, head + "\x01\0\0\0\xFF"s,
        "\x03\x02" + head.substr(2) + "\0\0\0\0"s, "\x03\0\0\0\xC0\x7F" + head.substr(6) + "\0\0\0\0"s})
    EXPECT_FALSE(read_binary_message(bytes)) << bytes.size();
}

TEST(FoxgloveServerMessage, PlaybackState) {
  EXPECT_EQ(playback_message({PlaybackWord::paused, 0x1112131415161718, 1.5, true}, "id"),
            "\x05\x01\x18\x17\x16\x15\x14\x13\x12\x11\0\0\xC0\x3F\x01\x02\0\0\0id"s);
  EXPECT_EQ(playback_message({PlaybackWord::ended, 5, 1, false}, {}),
            "\x05\x03\x05\0\0\0\0\0\0\0\0\0\x80\x3F\0\0\0\0\0"s);
}

TEST(FoxgloveServerMessage, OnlyARecordingOffersPlaybackControl) {
  ServerInfo info{"n", {}, "s"};
  EXPECT_FALSE(server_info_message(info).contains("playbackControl"));
  info.played = {1'700'000'000'000'000'001U, 1'700'000'002'500'000'000U};
  const std::string text = server_info_message(info);
  EXPECT_TRUE(text.contains(R"("assets","playbackControl"])")) << text;
  EXPECT_TRUE(text.contains(R"("dataStartTime":{"nsec":1,"sec":1700000000})")) << text;
  EXPECT_TRUE(text.contains(R"("dataEndTime":{"nsec":500000000,"sec":1700000002})")) << text;
}

TEST(FoxgloveClientMessage, ARequestForACommand) {
  const auto request = read_command_request(R"({"command":"BEEP","token":"t"})", 100);
  ASSERT_TRUE(request);
  EXPECT_EQ(request->command, "BEEP");
  EXPECT_EQ(request->token, "t");
  EXPECT_EQ(read_command_request(R"({"command":"BEEP"})", 100)->token, "");
  for (const char* bad : {"", "[]", "{}", R"({"command":""})", R"({"command":" \n"})", R"({"command":"a\u0000b"})",
                          R"({"command":"12345678901"})", R"({"command":"a","token":7})"})
    EXPECT_FALSE(read_command_request(bad, 10)) << bad;
}

TEST(FoxgloveServerMessage, BinaryHeads) {
  EXPECT_EQ(data_head(0x01020304, 0x1112131415161718), "\x01\x04\x03\x02\x01\x18\x17\x16\x15\x14\x13\x12\x11"s);
  EXPECT_EQ(data_head(1, 2).size(), kDataHead);
  EXPECT_EQ(time_message(5), "\x02\x05\0\0\0\0\0\0\0"s);
  EXPECT_EQ(service_response({1, 2, "json", {}}, "{}"), "\x03\x01\0\0\0\x02\0\0\0\x04\0\0\0json{}"s);
  EXPECT_EQ(asset_head(9), "\x04\x09\0\0\0\0\0\0\0\0"s);
  EXPECT_EQ(asset_failed_message(9, "no"), "\x04\x09\0\0\0\x01\x02\0\0\0no"s);
}

TEST(FoxgloveServerMessage, Texts) {
  EXPECT_EQ(status_message(StatusLevel::warning, "text"), R"({"level":1,"message":"text","op":"status"})");
  EXPECT_EQ(status_message(StatusLevel::error, "\xFF", "a"),
            "{\"id\":\"a\",\"level\":2,\"message\":\"\xEF\xBF\xBD\",\"op\":\"status\"}");
  EXPECT_EQ(service_failed_message(1, 2, "why"),
            R"({"callId":2,"message":"why","op":"serviceCallFailure","serviceId":1})");
  const std::vector<Parameter> parameters = {{"a", 1.5}, {"b", {}}};
  EXPECT_EQ(
      parameters_message(parameters, "r"),
      R"({"id":"r","op":"parameterValues","parameters":[{"name":"a","type":"float64","value":1.5},{"name":"b"}]})");
  const std::vector<Channel> channels = {{1, "/a", "cdr", "A", "int32 x", "ros2msg"}};
  EXPECT_EQ(
      advertise_message(channels),
      R"({"channels":[{"encoding":"cdr","id":1,"schema":"int32 x","schemaEncoding":"ros2msg","schemaName":"A","topic":"/a"}],"op":"advertise"})");
  EXPECT_EQ(advertise_message({}), R"({"channels":[],"op":"advertise"})");
  EXPECT_TRUE(server_info_message({"n", {{"k", "v"}}, "s"}).contains(R"("sessionId":"s")"));
}

}  // namespace
}  // namespace cellmirror::foxglove
