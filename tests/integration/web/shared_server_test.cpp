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
