// Clients of several users at one server: what one of them may take from the others.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <memory>
#include <string>
#include <vector>

#include "ipc/web/peer.hpp"
#include "ipc/web/web_server.hpp"
#include "tests/integration/web/raw_client.hpp"
#include "tests/integration/web/stub_backend.hpp"

namespace cellmirror::web {
namespace {

constexpr const char* kToken = "0123456789abcdef0123456789abcdef";
constexpr uid_t kNobody = 65534;

class SharedServer : public testing::Test {
 protected:
  void SetUp() override {
    ServerOptions options;
    options.port = 0;
    options.token = kToken;
    auto started = Server::start(options, backend);
    ASSERT_TRUE(started) << started.error().text();
    sut = std::move(*started);
  }

  // The first line of the answer to the opening of a WebSocket that stays open.
  std::string open(const std::string& more_headers = {}) {
    clients.push_back(std::make_unique<RawClient>(sut->port()));
    const std::string head = clients.back()->open_live(sut->port(), more_headers);
    return head.substr(0, head.find('\r'));
  }

  StubBackend backend;
  std::unique_ptr<Server> sut;
  std::vector<std::unique_ptr<RawClient>> clients;
};

const std::string kOpened = "HTTP/1.1 101 Switching Protocols";
const std::string kFull = "HTTP/1.1 503 Service Unavailable";
const std::string kWithBearer = std::string("Authorization: Bearer ") + kToken + "\r\n";
const std::string kWithSubprotocol =
    std::string("Sec-WebSocket-Protocol: cellmirror.live, cellmirror.token.") + kToken + "\r\n";

TEST_F(SharedServer, LeavesWebSocketsToWhoeverHasTheToken) {
  for (std::size_t i = 0; i < kMaxWebSocketsPerUser; ++i) ASSERT_EQ(open(), kOpened) << i;
  EXPECT_EQ(open(), kFull);
  EXPECT_EQ(open("Authorization: Bearer 0123456789abcdef0123456789abcdee\r\n"), kFull);
  EXPECT_EQ(open(kWithBearer), kOpened);
  EXPECT_EQ(open(kWithSubprotocol), kOpened);
}

TEST_F(SharedServer, TellsItsHealthByTheStatusOfAnAnswer) {
  const auto answer = [&] {
    RawClient client(sut->port());
    client.send("GET /healthz HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(sut->port()) + "\r\n\r\n");
    return client.read_to_end().value_or("");
  };
  EXPECT_TRUE(answer().starts_with("HTTP/1.1 200 OK\r\n")) << answer();
  EXPECT_TRUE(answer().ends_with("\r\n\r\nok\n")) << answer();
  backend.healthy = false;
  EXPECT_TRUE(answer().starts_with(kFull)) << answer();
  EXPECT_TRUE(answer().ends_with("\r\n\r\nthe loop stands still\n")) << answer();
}

TEST_F(SharedServer, SelectsTheSubprotocolOfThePage) {
  RawClient client(sut->port());
  const std::string head = client.open_live(sut->port(), kWithSubprotocol);
  EXPECT_NE(head.find("Sec-WebSocket-Protocol: cellmirror.live\r\n"), std::string::npos) << head;
  EXPECT_EQ(head.find(kToken), std::string::npos) << "the token is not sent back";
  RawClient other(sut->port());
  EXPECT_EQ(other.open_live(sut->port()).find("Sec-WebSocket-Protocol"), std::string::npos);
}

TEST_F(SharedServer, GivesBackThePlacesOfClientsThatAreGone) {
  for (int round = 0; round < 3; ++round) {
    for (std::size_t i = 0; i < kMaxWebSocketsPerUser; ++i) ASSERT_EQ(open(), kOpened) << round << " " << i;
    clients.clear();
    for (int i = 0; i < 6000 && sut->status().clients > 0; ++i) ::usleep(10'000);
  }
}

TEST_F(SharedServer, LeavesWebSocketsToOtherUsers) {
  if (::geteuid() != 0) GTEST_SKIP() << "skipped: needs root, to act as another user";
  for (std::size_t i = 0; i < kMaxWebSocketsPerUser; ++i) ASSERT_EQ(open(), kOpened) << i;
  ASSERT_EQ(open(), kFull);
  const int port = sut->port();
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    if (::setresuid(kNobody, kNobody, kNobody) != 0) ::_exit(2);
    RawClient client(port);
    ::_exit(client.open_live(port).starts_with(kOpened) ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(WEXITSTATUS(status), 0) << "1: it was refused; 2: it could not become another user";
}

// The server once checked 12,000 wrong tokens a second and logged nothing.
TEST_F(SharedServer, ChecksFewWrongTokensOfAUserAndDelaysNoOtherUser) {
  if (::geteuid() != 0) GTEST_SKIP() << "skipped: needs root, to act as another user";
  const int port = sut->port();
  const auto post = [port](const std::string& authorization) {
    RawClient client(port);
    client.send("POST /api/command HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) + "\r\n" + authorization +
                "Content-Length: 1\r\n\r\nA");
    return client.read_to_end().value_or("");
  };
  const std::string wrong_bearer = "Authorization: Bearer 0123456789abcdef0123456789abcdee\r\n";
  const auto count = [&](const std::string& status, const std::string& authorization, int tries) {
    int found = 0;
    for (int i = 0; i < tries; ++i) found += post(authorization).starts_with("HTTP/1.1 " + status) ? 1 : 0;
    return found;
  };
  const std::string first = post(wrong_bearer);
  EXPECT_TRUE(first.starts_with("HTTP/1.1 401 ")) << first;
  EXPECT_EQ(count("401", {}, 100), 100) << "a request without a token is not a guess";
  const int looked_at = count("401", wrong_bearer, 100);
  // A slow machine may check one more every ten seconds.
  EXPECT_LT(looked_at, 20);
  const std::string refused = post(wrong_bearer);
  EXPECT_TRUE(refused.starts_with("HTTP/1.1 429 ")) << refused;
  EXPECT_NE(refused.find("\r\nRetry-After: "), std::string::npos) << refused;
  EXPECT_NE(refused.find("too many wrong tokens from your address"), std::string::npos) << refused;
  // The same holds for every other way to send a token.
  EXPECT_GT(count("429", "Authorization: Basic YTpi\r\n", 10), 0);
  EXPECT_EQ(open("Authorization: Bearer guess\r\n"), "HTTP/1.1 429 Too Many Requests");
  EXPECT_EQ(open("Sec-WebSocket-Protocol: cellmirror.live, cellmirror.token.guess\r\n"),
            "HTTP/1.1 429 Too Many Requests");
  ASSERT_EQ(open(), kOpened) << "viewing needs no token";
  clients.back()->say(R"({"do": "hello", "token": "guess"})");
  EXPECT_FALSE(clients.back()->read_until("too many wrong tokens from your address").empty());
  EXPECT_GT(sut->status().unread_tokens, 50U);
  EXPECT_GE(sut->status().wrong_tokens, 10U);

  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    if (::setresuid(kNobody, kNobody, kNobody) != 0) ::_exit(2);
    for (int i = 0; i < 20; ++i) {
      if (!post(kWithBearer).starts_with("HTTP/1.1 200 ")) ::_exit(1);
    }
    RawClient client(port);
    ::_exit(client.open_live(port, kWithBearer).starts_with(kOpened) ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(WEXITSTATUS(status), 0) << "1: it was refused; 2: it could not become another user";
}

// 56.8 million of these were once accepted in 12 s: only whole messages were counted.
TEST_F(SharedServer, EndsAClientThatSendsEmptyFragments) {
  RawClient client(sut->port());
  client.open_live(sut->port());
  const std::string first("\x01\x80mask", 6);
  const std::string next("\x00\x80mask", 6);
  std::string fragments = first;
  for (int i = 0; i < 5000; ++i) fragments += next;
  client.send(fragments);
  EXPECT_FALSE(client.read_until("\x03\xF0too much").empty()) << "1008";
}

TEST_F(SharedServer, TakesAMessageInSomeParts) {
  RawClient client(sut->port());
  client.open_live(sut->port());
  const std::string parts =
      std::string("\x01\x81\0\0\0\0{", 7) + std::string("\x00\x80\0\0\0\0", 6) + std::string("\x80\x81\0\0\0\0}", 7);
  for (int i = 0; i < 100; ++i) client.send(parts);
  EXPECT_FALSE(client.read_until("\"is\":\"refused\"").empty()) << "{} says nothing, but it arrived";
}

TEST(PeerOf, NamesTheUserOfALocalProcess) {
  StubBackend backend;
  ServerOptions options;
  options.port = 0;
  const auto server = Server::start(options, backend);
  ASSERT_TRUE(server);
  RawClient client((*server)->port());
  ASSERT_TRUE(client.connected());
  // Seen from the client, the server is the peer: a process of the same user.
  EXPECT_EQ(peer_of(client.socket()), "uid " + std::to_string(::geteuid()));
  EXPECT_EQ(peer_of(-1), "unknown");
}

}  // namespace
}  // namespace cellmirror::web
