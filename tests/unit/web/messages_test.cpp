#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <variant>

#include "ipc/web/access.hpp"
#include "ipc/web/answer.hpp"
#include "ipc/web/client_message.hpp"
#include "ipc/web/flow.hpp"
#include "ipc/web/page_address.hpp"
#include "ipc/web/page_files.hpp"
#include "ipc/web/server_message.hpp"

namespace cellmirror::web {
namespace {

template <class Message>
Message expect(std::string_view text) {
  const auto message = read_client_message(text);
  if (!message) {
    ADD_FAILURE() << text << ": " << message.error().why;
    return {};
  }
  if (!std::holds_alternative<Message>(*message)) {
    ADD_FAILURE() << text << " is another message";
    return {};
  }
  return std::get<Message>(*message);
}

std::string why(std::string_view text) {
  const auto message = read_client_message(text);
  return message ? std::string() : message.error().why;
}

TEST(ClientMessages, AreRead) {
  EXPECT_EQ(expect<HelloMessage>(R"({"do": "hello", "token": "abc"})").token, "abc");
  EXPECT_EQ(expect<ShownMessage>(R"({"do": "shown", "sequence": 4294967295})").sequence, 4294967295u);
  const auto command = expect<CommandMessage>(R"({"do": "command", "id": 7, "text": "ROBACT A", "later": {}})");
  EXPECT_EQ(command.id, 7);
  EXPECT_EQ(command.text, "ROBACT A");
  const auto pick = expect<PickMessage>(R"({"do": "pick", "id": 8, "x": 100, "y": 50})");
  EXPECT_EQ(pick.x, 100);
  EXPECT_EQ(pick.y, 50);
  expect<NoPictureMessage>(R"({"do": "no_picture"})");
  expect<SceneMessage>(R"({"do": "scene"})");
  expect<NoSceneMessage>(R"({"do": "no_scene"})");
  EXPECT_EQ(expect<PosedMessage>(R"({"do": "posed", "sequence": 9})").sequence, 9u);
}

TEST(ClientMessages, WishPictures) {
  const auto plain = expect<PictureMessage>(R"({"do": "picture"})").request;
  EXPECT_EQ(plain.width, 640);
  EXPECT_FALSE(plain.view || plain.camera || plain.free_view);
  EXPECT_EQ(expect<PictureMessage>(R"({"do": "picture", "view": 6, "width": 320, "height": 200})").request.view, 6);
  EXPECT_EQ(expect<PictureMessage>(R"({"do": "picture", "camera": "C", "rate_hz": 7.5})").request.rate_hz, 7.5);
  const auto free = expect<PictureMessage>(
      R"({"do": "picture", "free": {"viewpoint_m": [1, 2, 3], "lookpoint_m": [0, 0, 0.5], "opening_angle_rad": 0.9}})");
  ASSERT_TRUE(free.request.free_view);
  EXPECT_EQ(free.request.free_view->viewpoint, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(free.request.free_view->opening_angle, 0.9);
}

TEST(ClientMessages, AreRefusedWithAReason) {
  for (const char* text : {"",
                           "{",
                           "[]",
                           "7",
                           "null",
                           R"({"do": 5})",
                           R"({"do": "fly"})",
                           R"({"do": "command", "text": "  "})",
                           R"({"do": "command"})",
                           R"({"do": "command", "text": 7})",
                           R"({"do": "command", "text": "a\u0000b"})",
                           R"({"do": "shown", "sequence": -1})",
                           R"({"do": "posed", "sequence": 4294967296})",
                           R"({"do": "shown", "sequence": 1e3})",
                           R"({"do": "shown", "sequence": 18446744073709551615})",
                           R"({"do": "pick", "x": 1.5})",
                           R"({"do": "picture", "view": 7})",
                           R"({"do": "picture", "view": 1, "camera": "C"})",
                           R"({"do": "picture", "width": 5000})",
                           R"({"do": "picture", "width": 8})",
                           R"({"do": "picture", "rate_hz": 0})",
                           R"({"do": "picture", "rate_hz": 1e-12})",
                           R"({"do": "picture", "rate_hz": 1e9})",
                           R"({"do": "picture", "quality": 0})",
                           R"({"do": "picture", "free": 1})",
                           R"({"do": "picture", "free": {"viewpoint_m": [1, 2], "lookpoint_m": [0, 0, 0]}})",
                           R"({"do": "picture", "free": {"viewpoint_m": [1, 2, "a"], "lookpoint_m": [0, 0, 0]}})",
                           R"({"do": "picture", "free": {"viewpoint_m": [1, 2, 3], "lookpoint_m": [1, 2, 3]}})",
                           R"({"do": "picture", "free": {"viewpoint_m": [1e9, 2, 3], "lookpoint_m": [0, 0, 0]}})",
                           R"({"do": "hello", "token": ["a"]})",
                           "{\"do\": \"hello\", \"token\": \"\xff\"}"}) {
    EXPECT_FALSE(why(text).empty()) << text;
  }
  const auto refused = read_client_message(R"({"do": "pick", "id": 9, "x": -1})");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().id, 9) << "the client is told which message it was";
  EXPECT_FALSE(why(std::string(10'000, '[')).empty());
}

TEST(PictureQuery, IsRead) {
  const auto picture = read_picture_query("view=3&width=800&height=600");
  ASSERT_TRUE(picture) << picture.error().text();
  EXPECT_EQ(picture->view, 3);
  EXPECT_EQ(picture->width, 800);
  EXPECT_EQ(read_picture_query("camera=A%20B")->camera, "A B");
  for (const char* query : {"view=9", "width=abc", "width=-5", "size=3", "view=1&camera=x", "a=%"})
    EXPECT_FALSE(read_picture_query(query)) << query;
}

TEST(ServerMessages, ReplaceBytesThatAreNoText) {
  EXPECT_EQ(reply_message(7, {false, "bad \xff"}),
            "{\"done\":false,\"id\":7,\"is\":\"reply\",\"text\":\"bad \xEF\xBF\xBD\"}");
  EXPECT_EQ(picked_message(8, std::nullopt), R"({"id":8,"is":"picked","path":null,"robot":""})");
  EXPECT_EQ(live_message(R"({"a":1})"), R"({"is":"live","a":1})");
  EXPECT_EQ(live_message("{}"), R"({"is":"live"})");
}

// By hand from docs/monitor-page.md.
TEST(PictureHeader, IsLaidOutAsDescribed) {
  EncodedImage picture;
  picture.width = 640;
  picture.height = 0x0102;
  picture.posture_time = Timestamp{1'000'000'000};
  const std::string sut = picture_header(0x01020304, picture, Timestamp{1'500'000'000});
  const std::string expected("CMP1\x04\x03\x02\x01\x80\x02\x02\x01\0\0\0\0\0\0\0\0\0\0\xE0\x3F\0\0\0\0\0\0\0\0", 32);
  EXPECT_EQ(sut, expected) << "0.5 s is 0x3FE0000000000000";
}

TEST(Hosts, AreThoseOfThisServer) {
  const AccessRules sut("127.0.0.1", 8420, {"https://cell.example.org"});
  for (const char* host :
       {"127.0.0.1:8420", "localhost:8420", "LOCALHOST:8420", "[::1]:8420", "127.0.0.2:8420", "cell.example.org"})
    EXPECT_TRUE(sut.host_allowed(host)) << host;
  for (const char* host : {"", "evil.example.org:8420", "127.0.0.1", "127.0.0.1:80", "localhost:84200", "10.0.0.1:8420",
                           "127.0.0.1.evil.org:8420", "localhost.evil.org:8420", "evil.org#localhost:8420"})
    EXPECT_FALSE(sut.host_allowed(host)) << host;
}

TEST(Hosts, OfAServerForOthersAreNumeric) {
  const AccessRules sut("0.0.0.0", 80, {});
  for (const char* host : {"192.168.1.5", "192.168.1.5:80", "[fe80::1]:80", "localhost"})
    EXPECT_TRUE(sut.host_allowed(host)) << host;
  for (const char* host : {"cell.example.org", "192.168.1.5:81"}) EXPECT_FALSE(sut.host_allowed(host)) << host;
}

TEST(Origins, AreThoseOfThisServer) {
  const AccessRules sut("127.0.0.1", 8420, {"https://cell.example.org"});
  const auto allowed = [&](const std::string& origin) { return sut.origin_allowed(&origin); };
  EXPECT_TRUE(sut.origin_allowed(nullptr));
  EXPECT_TRUE(allowed("http://127.0.0.1:8420"));
  EXPECT_TRUE(allowed("https://cell.example.org"));
  for (const char* origin : {"null", "", "http://evil.org", "https://127.0.0.1:8420", "http://127.0.0.1:9",
                             "http://127.0.0.1:8420.evil.org", "http://cell.example.org"})
    EXPECT_FALSE(allowed(origin)) << origin;
}

TEST(Origins, OfDesktopAppsHaveNoHost) {
  const AccessRules sut("127.0.0.1", 8420, {"file://"});
  const std::string desktop = "file://";
  const std::string other = "file:///home";
  EXPECT_TRUE(sut.origin_allowed(&desktop));
  EXPECT_FALSE(sut.origin_allowed(&other));
  EXPECT_FALSE(sut.host_allowed("")) << "it names no server";
}

TEST(Tokens, AreComparedWhole) {
  EXPECT_TRUE(token_matches("abc", "abc"));
  for (const char* given : {"", "ab", "abcd", "abd", "abcabc"}) EXPECT_FALSE(token_matches(given, "abc")) << given;
  EXPECT_FALSE(token_matches("", "")) << "no token is never right";
  HttpRequest request;
  request.headers = {{"authorization", "bearer  xyz"}};
  EXPECT_EQ(bearer_token(request), "xyz");
  request.headers = {{"authorization", "Basic xyz"}};
  EXPECT_EQ(bearer_token(request), "");
  const auto one = make_token();
  const auto two = make_token();
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->size(), 32u);
  EXPECT_NE(*one, *two);
}

TEST(PageAddress, IsTheLoopbackForAServerThatListensEverywhere) {
  EXPECT_EQ((PageAddress{"0.0.0.0", 80, "t", false}.url_with_token()), "http://127.0.0.1:80/#token=t");
  EXPECT_EQ((PageAddress{"::1", 8420, "t", true}.url_with_token()), "http://[::1]:8420/");
}

TEST(PictureCredit, LetsTwoPicturesBeUnderWay) {
  PictureCredit sut;
  EXPECT_EQ(sut.next(), 1u);
  EXPECT_TRUE(sut.may_send());
  EXPECT_EQ(sut.next(), 2u);
  EXPECT_FALSE(sut.may_send());
  sut.shown(7);
  EXPECT_FALSE(sut.may_send()) << "7 was never sent";
  sut.shown(1);
  EXPECT_TRUE(sut.may_send());
  sut.next();
  sut.shown(3);
  sut.shown(1);
  EXPECT_TRUE(sut.may_send()) << "an older one changes nothing";
}

TEST(RateLimit, LetsABurstThroughAndThenTheRate) {
  RateLimit sut(10);
  const Timestamp start{1'000'000'000};
  int allowed = 0;
  for (int i = 0; i < 100; ++i) allowed += sut.allows(start) ? 1 : 0;
  EXPECT_EQ(allowed, 20);
  EXPECT_TRUE(sut.allows(start + Nanoseconds(100'000'000)));
  EXPECT_FALSE(sut.allows(start + Nanoseconds(100'000'000)));
}

TEST(RateLimit, LetsAllOfANumberThroughOrNone) {
  RateLimit sut(10);
  const Timestamp start{1'000'000'000};
  EXPECT_FALSE(sut.allows(21, start));
  EXPECT_TRUE(sut.allows(20, start));
  EXPECT_FALSE(sut.allows(1, start));
  EXPECT_TRUE(sut.allows(0, start));
}

TEST(Answers, CarryWhatKeepsThePageApart) {
  const std::string head = head_of(text_answer(200, "x"), Timestamp{1});
  for (const char* part :
       {"HTTP/1.1 200 OK\r\n", "Content-Security-Policy: default-src 'none'", "nosniff", "X-Frame-Options: DENY",
        "Cache-Control: no-store", "Connection: close", "Content-Length: 2\r\n"})
    EXPECT_NE(head.find(part), std::string::npos) << part;
}

TEST(PageFiles, AreServedCompressedAndOnlyWhereTheyAreNew) {
  const PageFile* index = find_page_file(page_files(), "/");
  ASSERT_NE(index, nullptr);
  EXPECT_EQ(index->content_type, "text/html; charset=utf-8");
  EXPECT_EQ(find_page_file(page_files(), "/page/index.html"), nullptr);
  EXPECT_EQ(find_page_file(page_files(), "/page/../CMakeLists.txt"), nullptr);
  HttpRequest request;
  const Answer plain = file_answer(*index, request);
  EXPECT_EQ(plain.body.bytes, index->bytes);
  request.headers = {{"accept-encoding", "br, gzip"}};
  const Answer compressed = file_answer(*index, request);
  EXPECT_EQ(compressed.body.bytes.substr(0, 2), "\x1f\x8b");
  request.headers = {{"if-none-match", std::string(index->etag)}};
  EXPECT_EQ(file_answer(*index, request).status, 304);
  std::size_t page = 0;
  std::size_t in_3d = 0;  // what is loaded when 3D is chosen
  for (const PageFile& file : page_files()) {
    std::size_t& sum = file.path.starts_with("/page/lib/three") ? in_3d : page;
    sum += file.gzip.empty() ? file.bytes.size() : file.gzip.size();
  }
  EXPECT_LT(page, 150'000u) << "bytes on the wire for the page";
  EXPECT_LT(in_3d, 300'000u);
  EXPECT_GT(in_3d, 100'000u) << "three.js is not there";
}

}  // namespace
}  // namespace cellmirror::web
