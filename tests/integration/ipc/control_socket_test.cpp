#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "ipc/control/control_client.hpp"
#include "ipc/control/control_request.hpp"
#include "ipc/control/control_server.hpp"
#include "ipc/control/instance.hpp"
#include "tests/unit/ipc/temporary_folder.hpp"

namespace cellmirror {
namespace {

using test::TemporaryFolder;

constexpr Nanoseconds kLong{60'000'000'000};
constexpr Nanoseconds kShort{50'000'000};
// For clients of a server that cuts them off, and those that it is to answer: the machine may be late.
constexpr Nanoseconds kCutAfter{300'000'000};

std::string answer(std::string_view request) {
  const auto parsed = parse_control_request(request);
  if (!parsed) return control_error(parsed.error());
  if (parsed->request == "big") return "\"" + std::string(3'000'000, 'b') + "\"";
  if (parsed->request == "throw") throw std::runtime_error("handler");
  return "{\"you asked\": \"" + parsed->request + "\"}";
}

// A client that does as it likes.
class RawClient {
 public:
  explicit RawClient(const std::filesystem::path& path) : socket_(::socket(AF_UNIX, SOCK_STREAM, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.native().copy(address.sun_path, sizeof address.sun_path - 1);
    connected_ = ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }
  ~RawClient() { ::close(socket_); }
  [[nodiscard]] bool connected() const { return connected_; }
  bool send(std::string_view text) const {
    return ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size());
  }
  // Until the server closes.
  [[nodiscard]] std::string rest() const {
    std::string text;
    char chunk[4096];
    for (ssize_t got; (got = ::recv(socket_, chunk, sizeof chunk, 0)) > 0;) {
      text.append(chunk, static_cast<std::size_t>(got));
    }
    return text;
  }

 private:
  int socket_;
  bool connected_ = false;
};

class ControlSocket : public ::testing::Test {
 protected:
  void start(Nanoseconds client_timeout = kLong) {
    auto started = ControlServer::start(path_, answer, client_timeout);
    ASSERT_TRUE(started) << started.error().text();
    sut_ = std::move(*started);
  }
  Result<std::string> ask(std::string_view request, Nanoseconds timeout = kLong) {
    return control_request_at(path_, "test", request, timeout);
  }
  // A client that was late itself may have been cut off, and asks again.
  bool answers_in_the_end() {
    for (int i = 0; i < 100; ++i) {
      if (ask(R"({"request":"status"})")) return true;
    }
    return false;
  }
  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "control.sock";
  std::unique_ptr<ControlServer> sut_;
};

TEST_F(ControlSocket, AnswersARequest) {
  start();
  EXPECT_EQ(ask(R"({"request":"status"})"), R"({"you asked": "status"})");
  EXPECT_EQ(sut_->status().answered, 1u);
}

TEST_F(ControlSocket, IsForItsUserAlone) {
  start();
  struct stat made{};
  ASSERT_EQ(::stat(path_.c_str(), &made), 0);
  EXPECT_EQ(made.st_mode & 0777u, 0600u);
}

TEST_F(ControlSocket, OtherUsersAreRefused) {
  if (::geteuid() != 0) GTEST_SKIP() << "skipped: only root can become another user";
  start();
  // The doors before are opened, so that the server itself has to refuse.
  ASSERT_EQ(::chmod(folder_.path().c_str(), 0755), 0);
  ASSERT_EQ(::chmod(path_.c_str(), 0666), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    if (::setresuid(65534, 65534, 65534) != 0) _exit(2);
    const RawClient client(path_);
    client.send("{\"request\":\"status\"}\n");
    _exit(client.rest().find("only the gateway's user and root are allowed") != std::string::npos ? 0 : 1);
  }
  int status = 1;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(sut_->status().refused, 1u);
  EXPECT_EQ(sut_->status().answered, 0u);
}

TEST_F(ControlSocket, RefusalsAreErrorsOfTheClient) {
  start();
  const auto refused = ask("nonsense");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().what, "the request is not a JSON object");
}

TEST_F(ControlSocket, LargeAnswersArriveWhole) {
  start();
  const auto sut = ask(R"({"request":"big"})");
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_EQ(sut->size(), 3'000'002u);
}

TEST_F(ControlSocket, ThrowingHandlerIsAnAnswer) {
  start();
  EXPECT_FALSE(ask(R"({"request":"throw"})"));
  EXPECT_TRUE(ask(R"({"request":"status"})")) << "the server goes on";
}

TEST_F(ControlSocket, RequestInPiecesIsPutTogether) {
  start();
  const RawClient client(path_);
  for (const auto* piece : {"{\"requ", "est\":\"sta", "tus\"}", "\r\n"}) ASSERT_TRUE(client.send(piece));
  EXPECT_EQ(client.rest(), "{\"you asked\": \"status\"}\n");
}

TEST_F(ControlSocket, TooLongARequestIsRefused) {
  start();
  const RawClient client(path_);
  client.send(std::string(kMaxControlRequestBytes + 10, 'x'));
  EXPECT_NE(client.rest().find("longer than 65536 bytes"), std::string::npos);
  EXPECT_EQ(sut_->status().refused, 1u);
}

TEST_F(ControlSocket, StalledClientsAreCutOffAndHinderNobody) {
  start(kCutAfter);
  const RawClient silent(path_);
  const RawClient half(path_);
  half.send("{\"request\":");
  EXPECT_TRUE(answers_in_the_end());
  EXPECT_EQ(silent.rest(), "") << "closed by the server";
  EXPECT_EQ(half.rest(), "");
  EXPECT_GE(sut_->status().cut, 2u);
}

TEST_F(ControlSocket, ClientThatDoesNotReadIsCutOff) {
  start(kCutAfter);
  const RawClient deaf(path_);
  ASSERT_TRUE(deaf.send("{\"request\":\"big\"}\n"));
  while (sut_->status().cut == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_TRUE(answers_in_the_end());
  EXPECT_LT(deaf.rest().size(), 3'000'000u);
}

TEST_F(ControlSocket, ManyStalledClientsDoNotKeepNewcomersOut) {
  start();
  std::vector<std::unique_ptr<RawClient>> stalled;
  for (std::size_t i = 0; i < 2 * ControlServer::kMaxClients; ++i) {
    stalled.push_back(std::make_unique<RawClient>(path_));
  }
  EXPECT_TRUE(ask(R"({"request":"status"})"));
}

TEST_F(ControlSocket, ManyClientsAtOnceAreAllAnswered) {
  start();
  std::atomic<int> good{0};
  std::vector<std::thread> clients;
  for (int c = 0; c < 16; ++c) {
    clients.emplace_back([&] {
      for (int i = 0; i < 50; ++i) good += ask(R"({"request":"status"})").has_value() ? 1 : 0;
    });
  }
  for (std::thread& client : clients) client.join();
  EXPECT_EQ(good, 16 * 50);
}

TEST_F(ControlSocket, ClientsThatLeaveEarlyDoNoHarm) {
  start();
  for (int i = 0; i < 100; ++i) {
    const RawClient client(path_);
    if (i % 3 == 1) client.send("{\"request\":\"big\"}\n");
    if (i % 3 == 2) client.send("half");
  }
  EXPECT_TRUE(ask(R"({"request":"status"})"));
}

TEST_F(ControlSocket, SocketThatWasLeftBehindIsReplaced) {
  start();
  // A killed gateway removes nothing: another server at the same path finds its socket.
  auto second = ControlServer::start(path_, answer);
  ASSERT_TRUE(second);
  EXPECT_TRUE(ask(R"({"request":"status"})"));
  EXPECT_EQ((*second)->status().answered, 1u);
}

TEST_F(ControlSocket, EndRemovesTheSocket) {
  start();
  sut_.reset();
  EXPECT_FALSE(std::filesystem::exists(path_));
  const auto refused = ask(R"({"request":"status"})");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().what, "no gateway of the instance test is running");
}

TEST_F(ControlSocket, SlowHandlerEndsInATimeOutOfTheClient) {
  std::atomic<bool> over{false};
  auto started = ControlServer::start(path_, [&](std::string_view) {
    while (!over) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return std::string("{}");
  });
  ASSERT_TRUE(started);
  const auto refused = ask(R"({"request":"status"})", kShort);
  over = true;
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("did not answer within 0.05 s"), std::string::npos) << refused.error().text();
}

// A picture takes its time: others are answered meanwhile.
TEST_F(ControlSocket, LateAnswersHoldUpNobody) {
  std::vector<ControlReply> owed;
  std::mutex mutex;
  auto server = ControlServer::start_later(path_, [&](std::string_view request, ControlReply reply) {
    const auto parsed = parse_control_request(request);
    if (parsed && parsed->request == "quick") return reply("{\"quick\": true}");
    const std::scoped_lock lock(mutex);
    owed.push_back(std::move(reply));
  });
  ASSERT_TRUE(server) << server.error().text();
  Result<std::string> late = fail("not asked");
  Result<std::string> forgotten = fail("not asked");
  std::thread asks([&] { late = control_request_at(path_, "test", R"({"request":"late"})", kLong); });
  const auto owes = [&](std::size_t wanted) {
    for (;;) {
      const std::scoped_lock lock(mutex);
      if (owed.size() == wanted) return;
    }
  };
  owes(1);
  std::thread asks_too([&] { forgotten = control_request_at(path_, "test", R"({"request":"late"})", kLong); });
  owes(2);
  const auto quick = control_request_at(path_, "test", R"({"request":"quick"})", kLong);
  ASSERT_TRUE(quick) << quick.error().text();
  EXPECT_EQ(*quick, "{\"quick\": true}");
  owed[0]("{\"late\": true}");
  owed.pop_back();
  asks.join();
  asks_too.join();
  ASSERT_TRUE(late) << late.error().text();
  EXPECT_EQ(*late, "{\"late\": true}");
  ASSERT_FALSE(forgotten) << "an answer that is never given is a refusal";
  RawClient leaves(path_);
  ASSERT_TRUE(leaves.send("{\"request\":\"late\"}\n"));
  owes(2);
  server->reset();
  owed.back()("too late for anybody");
}

TEST_F(ControlSocket, TooLongAPathIsRefused) {
  const auto refused = ControlServer::start(folder_.path() / std::string(120, 'x'), answer);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().remedy.find("CELLMIRROR_RUNTIME_DIR"), std::string::npos);
}

TEST(ControlRequestToAnInstance, FindsItsSocket) {
  const auto claimed = Instance::claim({"line_2", 0, "cell.toml", default_queues("line_2")});
  ASSERT_TRUE(claimed) << claimed.error().text();
  const auto server = ControlServer::start(claimed->control_socket(), answer);
  ASSERT_TRUE(server) << server.error().text();
  EXPECT_TRUE(control_request("line_2", R"({"request":"status"})", kLong));
  const auto refused = control_request("default", R"({"request":"status"})", kLong);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().text(),
            "no gateway of the instance default is running; start one with cellmirror run CELL.toml");
}

}  // namespace
}  // namespace cellmirror
