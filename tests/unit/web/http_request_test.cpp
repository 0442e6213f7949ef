#include "ipc/web/http_request.hpp"

#include <gtest/gtest.h>

#include <string>

namespace cellmirror::web {
namespace {

constexpr std::size_t kMostBody = 1000;

ReadHead read(const std::string& lines) { return read_http_head(lines + "\r\n\r\n", kMostBody); }

int refusal(const std::string& lines) {
  const ReadHead head = read(lines);
  return head.refused ? head.refused->status : 0;
}

TEST(HttpHead, GivesMethodPathQueryAndHeaders) {
  const std::string text =
      "GET /page/a%20b.js?view=3&x=%2F HTTP/1.1\r\nHost: localhost:8420\r\nX-A:  one two \r\n\r\nrest";
  const ReadHead sut = read_http_head(text, kMostBody);
  ASSERT_FALSE(sut.refused);
  EXPECT_EQ(sut.bytes, text.size() - 4);
  EXPECT_EQ(sut.request.method, "GET");
  EXPECT_EQ(sut.request.path, "/page/a b.js");
  EXPECT_EQ(sut.request.query, "view=3&x=%2F");
  ASSERT_NE(sut.request.header("x-a"), nullptr);
  EXPECT_EQ(*sut.request.header("x-a"), "one two");
  EXPECT_EQ(sut.request.header("x-b"), nullptr);
}

TEST(HttpHead, WaitsForTheRest) {
  const std::string text = "GET / HTTP/1.1\r\nHost: a\r\n\r\n";
  for (std::size_t length = 0; length < text.size(); ++length) {
    const ReadHead sut = read_http_head(text.substr(0, length), kMostBody);
    EXPECT_FALSE(sut.refused) << length;
    EXPECT_EQ(sut.bytes, 0u) << length;
  }
}

TEST(HttpHead, RefusesWhatIsNoRequest) {
  EXPECT_EQ(refusal("nonsense"), 400);
  EXPECT_EQ(refusal("GET / HTTP/2.0\r\nHost: a"), 505);
  EXPECT_EQ(refusal("GET  / HTTP/1.1\r\nHost: a"), 400) << "two blanks: an empty address";
  EXPECT_EQ(refusal("GET http://a/ HTTP/1.1\r\nHost: a"), 400);
  EXPECT_EQ(refusal("G(T / HTTP/1.1\r\nHost: a"), 400);
  EXPECT_EQ(refusal("GET / HTTP/1.1\r\nHost : a"), 400) << "a blank before the colon";
  EXPECT_EQ(refusal("GET / HTTP/1.1\r\nHost: a\r\n more"), 400) << "a header that goes on in the next line";
  EXPECT_EQ(refusal(std::string("GET / HTTP/1.1\r\nHost: a\r\nX: \0", 30)), 400);
  EXPECT_TRUE(read_http_head("\x16\x03\x01\x02", kMostBody).refused) << "TLS is refused at once, not waited for";
}

TEST(HttpHead, WantsOneHost) {
  EXPECT_EQ(refusal("GET / HTTP/1.1"), 400);
  EXPECT_EQ(refusal("GET / HTTP/1.1\r\nHost: a\r\nHost: b"), 400);
}

TEST(HttpHead, RefusesPathsThatLeaveTheirFolder) {
  for (const char* path :
       {"/../etc/passwd", "/page/../../x", "/page/%2e%2e/x", "/a/..", "/a%5C..%5Cb", "/a%00", "/%zz", "/%2"}) {
    EXPECT_EQ(refusal("GET " + std::string(path) + " HTTP/1.1\r\nHost: a"), 400) << path;
  }
  EXPECT_EQ(refusal("GET /page/..a/...x HTTP/1.1\r\nHost: a"), 0) << "dots within a name";
}

TEST(HttpHead, BoundsEverything) {
  EXPECT_EQ(refusal("GET /" + std::string(kMaxTargetBytes, 'a') + " HTTP/1.1\r\nHost: a"), 414);
  std::string many = "GET / HTTP/1.1\r\nHost: a";
  for (std::size_t i = 0; i < kMaxHeaders; ++i) many += "\r\nX: y";
  EXPECT_EQ(refusal(many), 431);
  EXPECT_EQ(read_http_head("GET / HTTP/1.1\r\nX: " + std::string(kMaxHeadBytes, 'a'), kMostBody).refused->status, 431);
}

TEST(HttpHead, SaysHowLongTheBodyIs) {
  const auto length = [](const std::string& value) { return "POST / HTTP/1.1\r\nHost: a\r\nContent-Length: " + value; };
  EXPECT_EQ(read(length("1000")).request.body_bytes, 1000u);
  EXPECT_EQ(refusal(length("1001")), 413);
  EXPECT_EQ(refusal(length("99999999999999999999999")), 413);
  EXPECT_EQ(refusal(length("-1")), 400);
  EXPECT_EQ(refusal(length("1\r\nContent-Length: 2")), 400);
  EXPECT_EQ(refusal(length("")), 400);
  EXPECT_EQ(refusal("POST / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked"), 501);
}

TEST(HttpRequestHeaders, AreListsOfWords) {
  const ReadHead sut = read("GET / HTTP/1.1\r\nHost: a\r\nConnection: keep-alive, Upgrade\r\nConnection: x");
  EXPECT_TRUE(sut.request.header_has("connection", "upgrade"));
  EXPECT_TRUE(sut.request.header_has("connection", "X"));
  EXPECT_FALSE(sut.request.header_has("connection", "keep"));
}

TEST(QueryParts, AreDecoded) {
  const auto sut = query_parts("camera=UMG%20Kamera+1&view=&&x");
  ASSERT_TRUE(sut);
  ASSERT_EQ(sut->size(), 3u);
  EXPECT_EQ((*sut)[0].second, "UMG Kamera 1");
  EXPECT_EQ((*sut)[1].first, "view");
  EXPECT_EQ((*sut)[2].first, "x");
  EXPECT_FALSE(query_parts("a=%f"));
  std::string many;
  for (int i = 0; i < 40; ++i) many += "a=b&";
  EXPECT_FALSE(query_parts(many));
}

}  // namespace
}  // namespace cellmirror::web
