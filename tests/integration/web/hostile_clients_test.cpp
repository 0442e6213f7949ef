// Clients that are malformed, oversized, slow, strange or not allowed, over real sockets.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "ipc/web/web_server.hpp"
#include "tests/integration/web/raw_client.hpp"
#include "tests/integration/web/stub_backend.hpp"

namespace cellmirror::web {
namespace {

using namespace std::string_literals;

constexpr const char* kToken = "0123456789abcdef0123456789abcdef";

class HostileClients : public testing::Test {
 protected:
  // Of the patient server nobody is cut because the machine was late; the other one is for what is to be cut.
  void start(bool read_only = false, bool patient = true) {
    sut.reset();
    ServerOptions options;
    options.port = 0;
    options.token = kToken;
    options.read_only = read_only;
    options.patience.request = Nanoseconds(patient ? 20'000'000'000 : 700'000'000);
    options.patience.sending = Nanoseconds(patient ? 20'000'000'000 : 1'000'000'000);
    options.patience.ping = Nanoseconds(400'000'000);
    options.patience.silence = Nanoseconds(patient ? 30'000'000'000 : 2'500'000'000);
    auto started = Server::start(options, backend);
    ASSERT_TRUE(started) << started.error().text();
    sut = std::move(*started);
  }
  void SetUp() override { start(); }
  static bool soon(const std::function<bool()>& condition) {
    for (int i = 0; i < 6000; ++i) {
      if (condition()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }

  [[nodiscard]] std::string host() const { return "Host: 127.0.0.1:" + std::to_string(sut->port()) + "\r\n"; }
  // The whole answer to a request.
  [[nodiscard]] std::string ask(const std::string& request) const {
    RawClient client(sut->port());
    client.send(request);
    return client.read_to_end().value_or("no end of the connection");
  }
  [[nodiscard]] std::string get(const std::string& path) const {
    return ask("GET " + path + " HTTP/1.1\r\n" + host() + "\r\n");
  }
  [[nodiscard]] bool works() const { return get("/api/status").find("\"version\"") != std::string::npos; }

  StubBackend backend;
  std::unique_ptr<Server> sut;
};

bool starts(const std::string& answer, int status) {
  return answer.starts_with("HTTP/1.1 " + std::to_string(status) + " ");
}

TEST_F(HostileClients, OnlyWhoOpensThePageIsTakenForAVisitor) {
  EXPECT_TRUE(works());
  EXPECT_FALSE(starts(ask("GET / HTTP/1.1\r\nHost: elsewhere.example\r\n\r\n"), 200));
  EXPECT_EQ(backend.expected, 0);
  EXPECT_TRUE(starts(get("/"), 200));
  EXPECT_EQ(backend.expected, 1);
}

TEST_F(HostileClients, AreAnsweredWithAStatusAndNothingElseHappens) {
  const auto post = [&](const std::string& headers, const std::string& body) {
    return ask("POST /api/command HTTP/1.1\r\n" + host() + headers + "Content-Length: " + std::to_string(body.size()) +
               "\r\n\r\n" + body);
  };
  const std::string bearer = "Authorization: Bearer "s + kToken + "\r\n";
  EXPECT_TRUE(starts(ask("nonsense\r\n\r\n"), 400));
  EXPECT_TRUE(starts(ask("\x16\x03\x01\x02\x00\x01"s), 400)) << "TLS";
  EXPECT_TRUE(starts(get("/../../etc/passwd"), 400));
  EXPECT_TRUE(starts(get("/page/%2e%2e/%2e%2e/etc/passwd"), 400));
  EXPECT_TRUE(starts(get("/page/index.html"), 404));
  EXPECT_TRUE(starts(get("/" + std::string(4000, 'a')), 414));
  EXPECT_TRUE(starts(ask("GET / HTTP/1.1\r\n" + host() + "X: " + std::string(20'000, 'a') + "\r\n\r\n"), 431));
  EXPECT_TRUE(starts(ask("DELETE / HTTP/1.1\r\n" + host() + "\r\n"), 405));
  EXPECT_TRUE(starts(get("/snapshot.png?view=12"), 400));
  EXPECT_TRUE(starts(get("/api/command"), 405));
  EXPECT_TRUE(starts(post("", "ROBACT A"), 401));
  EXPECT_TRUE(starts(post("Authorization: Bearer 0123456789abcdef0123456789abcdee\r\n", "ROBACT A"), 401));
  EXPECT_TRUE(starts(post(bearer, std::string(40'000, 'a')), 413));
  EXPECT_TRUE(starts(post(bearer, "  "), 400));
  EXPECT_TRUE(starts(get("/live"), 426));
  EXPECT_TRUE(backend.commands.empty());
  EXPECT_TRUE(works());
  EXPECT_GE(sut->status().refused, 10u);
}

TEST_F(HostileClients, OfOtherNamesAndOriginsAreRefused) {
  const auto with = [&](const std::string& headers) { return ask("GET /api/status HTTP/1.1\r\n" + headers + "\r\n"); };
  EXPECT_TRUE(starts(with("Host: evil.example.org:" + std::to_string(sut->port()) + "\r\n"), 421)) << "DNS rebinding";
  EXPECT_TRUE(starts(with(host() + "Origin: http://evil.example.org\r\n"), 403));
  EXPECT_TRUE(starts(with(host() + "Origin: null\r\n"), 403));
  RawClient client(sut->port());
  EXPECT_TRUE(starts(client.open_live(sut->port(), "Origin: http://evil.example.org\r\n"), 403));
}

TEST_F(HostileClients, ThatAreSlowAreCut) {
  start(false, false);
  const auto begin = std::chrono::steady_clock::now();
  RawClient slow(sut->port());
  bool open = true;
  for (int i = 0; i < 1000 && open; ++i) {  // a byte now and then: the whole request has a time
    open = slow.send(i == 0 ? "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nX: " : "a");
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    open = open && sut->status().cut == 0;
  }
  EXPECT_EQ(sut->status().cut, 1u);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

TEST_F(HostileClients, InGreatNumberLeaveRoomForOthers) {
  std::vector<std::unique_ptr<RawClient>> idle;
  for (std::size_t i = 0; i < 2 * kMaxConnections; ++i) idle.push_back(std::make_unique<RawClient>(sut->port()));
  EXPECT_TRUE(works()) << "the oldest that asks for nothing makes room";
}

TEST_F(HostileClients, MayNotOpenMoreWebSocketsThanThereAre) {
  std::vector<std::unique_ptr<RawClient>> live;
  for (std::size_t i = 0; i < kMaxWebSocketsPerUser; ++i) {
    live.push_back(std::make_unique<RawClient>(sut->port()));
    ASSERT_TRUE(starts(live.back()->open_live(sut->port()), 101)) << i;
  }
  RawClient one_more(sut->port());
  EXPECT_TRUE(starts(one_more.open_live(sut->port()), 503));
  EXPECT_TRUE(works());
}

TEST_F(HostileClients, AreToldWhichMessageWasWrong) {
  RawClient client(sut->port());
  ASSERT_TRUE(starts(client.open_live(sut->port()), 101));
  EXPECT_FALSE(client.read_until("\"is\":\"welcome\"").empty());
  client.say("{");
  EXPECT_FALSE(client.read_until("\"is\":\"refused\"").empty());
  client.say(R"({"do": "command", "id": 5, "text": "ROBACT A"})");
  EXPECT_FALSE(client.read_until("cellmirror page").empty()) << "no token yet; it says how to get it";
  client.say(R"({"do": "hello", "token": "wrong"})");
  EXPECT_FALSE(client.read_until("\"is\":\"refused\"").empty());
  client.say("{\"do\": \"hello\", \"token\": \""s + kToken + "\"}");
  EXPECT_FALSE(client.read_until("\"may_command\":true").empty());
  client.say(R"({"do": "command", "id": 6, "text": "BAD"})");
  EXPECT_FALSE(client.read_until("there is no such command").empty());
  client.say(R"({"do": "pick", "id": 7, "x": 1, "y": 1})");
  EXPECT_FALSE(client.read_until("no picture").empty());
  EXPECT_EQ(backend.commands, std::vector<std::string>{"BAD"});
}

TEST_F(HostileClients, WithWrongTokensOrFramesAreCut) {
  RawClient guesser(sut->port());
  guesser.open_live(sut->port());
  for (int i = 0; i < 3; ++i) guesser.say(R"({"do": "hello", "token": "guess"})");
  EXPECT_TRUE(guesser.read_to_end(15)) << "three wrong tokens";
  // Not masked; far too long; a reserved bit.
  for (const std::string& frame : {"\x81\x05Hello"s, "\x81\xFF\x7F\xFF\xFF\xFF\xFF\xFF\xFF\xFF"s, "\xC1\x80mask"s}) {
    RawClient client(sut->port());
    client.open_live(sut->port());
    client.send(frame);
    EXPECT_TRUE(client.read_to_end(15)) << "a frame that is refused ends the connection";
  }
  EXPECT_TRUE(works());
}

TEST_F(HostileClients, MayNotFlood) {
  RawClient client(sut->port());
  client.open_live(sut->port());
  client.say("{\"do\": \"hello\", \"token\": \""s + kToken + "\"}");
  const Timestamp begin = SystemClock().now();
  for (int i = 0; i < 1000; ++i) client.say(R"({"do": "command", "id": 1, "text": "A"})");
  EXPECT_FALSE(client.read_until("too many commands").empty());
  const std::scoped_lock lock(backend.mutex);
  const double meanwhile = kCommandsPerSecond * seconds(SystemClock().now() - begin);
  EXPECT_LT(static_cast<double>(backend.commands.size()), 2 * kCommandsPerSecond + meanwhile + 1)
      << "a burst, and what comes meanwhile";
}

TEST_F(HostileClients, MayNotFloodWithPings) {
  RawClient client(sut->port());
  client.open_live(sut->port());
  for (int i = 0; i < 5000 && client.say("", 9); ++i) {
  }
  EXPECT_FALSE(client.read_until("\x03\xF0too much").empty()) << "1008";
  EXPECT_TRUE(works());
}

TEST_F(HostileClients, MayNotFloodByRequests) {
  const std::string request =
      "POST /api/command HTTP/1.1\r\n" + host() + "Authorization: Bearer " + kToken + "\r\nContent-Length: 1\r\n\r\nA";
  std::string refused;
  // Many at once: a slow machine asks no faster than is allowed if it waits for each answer.
  for (int i = 0; i < 20 && refused.empty(); ++i) {
    std::vector<std::unique_ptr<RawClient>> asking;
    for (int k = 0; k < 60; ++k) {
      asking.push_back(std::make_unique<RawClient>(sut->port()));
      asking.back()->send(request);
    }
    for (const auto& client : asking) {
      if (const std::string answered = client->read_to_end().value_or(""); !starts(answered, 200)) refused = answered;
    }
  }
  EXPECT_TRUE(starts(refused, 429)) << refused;
  EXPECT_NE(refused.find("Retry-After: 1\r\n"), std::string::npos) << refused;
}

TEST_F(HostileClients, ThatSayGoodbyeHearTheirCode) {
  RawClient client(sut->port());
  client.open_live(sut->port());
  client.say("\x0F\xA1 bye", 8);
  EXPECT_NE(client.read_to_end().value_or("").find("\x88\x02\x0F\xA1"), std::string::npos) << "4001";
}

// More than the pool has places for, each of them 0.3 s of work: news come in between.
TEST_F(HostileClients, ThatAskForManyDocumentsDoNotStopTheNews) {
  RawClient page(sut->port());
  page.open_live(sut->port());
  ASSERT_FALSE(page.read_until("\"is\":\"live\"").empty());
  std::vector<std::unique_ptr<RawClient>> asking;
  for (int i = 0; i < 40; ++i) {
    asking.push_back(std::make_unique<RawClient>(sut->port()));
    asking.back()->send("GET /api/names HTTP/1.1\r\n" + host() + "\r\n");
  }
  ASSERT_TRUE(soon([&] { return sut->status().requests >= 40; }));
  const int before = backend.lives;
  ASSERT_TRUE(soon([&] { return backend.names >= 10; }));
  EXPECT_GE(backend.lives - before, 3) << "while at least eight documents of 0.3 s were made, two at a time";
}

TEST_F(HostileClients, AreToldOnceAWishWhyNoPictureComes) {
  RawClient client(sut->port());
  client.open_live(sut->port());
  backend.pictures_fail = true;
  for (int wish = 0; wish < 2; ++wish) {
    client.say(R"({"do": "picture", "camera": "C"})");
    EXPECT_FALSE(client.read_until("there is no camera C").empty()) << wish;
  }
  // It would be said again every 5 ms; news come every 100 ms.
  for (int i = 0; i < 2; ++i)
    EXPECT_EQ(client.read_until("\"is\":\"live\"").find("there is no camera C"), std::string::npos);
  backend.pictures_fail = false;
  EXPECT_FALSE(client.read_until("CMP1").empty());
}

TEST_F(HostileClients, ThatDoNotAcknowledgeGetTwoPictures) {
  RawClient client(sut->port());
  client.open_live(sut->port());
  client.say(R"({"do": "picture", "rate_hz": 60})");
  EXPECT_FALSE(client.read_until("CMP1").empty());
  EXPECT_FALSE(client.read_until("CMP1").empty());
  EXPECT_TRUE(client.read_until("CMP1", 0.5).empty()) << "not acknowledged";
  EXPECT_EQ(sut->status().pictures, 2u);
  client.say(R"({"do": "shown", "sequence": 1})");
  EXPECT_FALSE(client.read_until("CMP1").empty());
  EXPECT_GE(sut->status().pictures_left_out, 2u) << "in half a second at 60 a second";
}

TEST_F(HostileClients, ThatDoNotAcknowledgePosesGetTwo) {
  RawClient client(sut->port());
  client.open_live(sut->port());
  EXPECT_TRUE(client.read_until("CMS1", 0.3).empty()) << "who did not ask gets none";
  client.say(R"({"do": "scene"})");
  EXPECT_FALSE(client.read_until("\"is\":\"marks\"").empty()) << "words come before the poses that they belong to";
  EXPECT_FALSE(client.read_until("CMS1").empty());
  EXPECT_FALSE(client.read_until("CMT1").empty()) << "the shape of tissue comes before its motion";
  EXPECT_FALSE(client.read_until("CMM1").empty());
  EXPECT_FALSE(client.read_until("CMS1").empty());
  const std::string second = client.read_until("CMM1");
  EXPECT_FALSE(second.empty());
  EXPECT_EQ(second.find("CMT1"), std::string::npos) << "once, while nothing is cut";
  EXPECT_TRUE(client.read_until("CMS1", 0.5).empty()) << "not acknowledged";
  client.say(R"({"do": "posed", "sequence": 4000000000})");
  EXPECT_TRUE(client.read_until("CMS1", 0.3).empty()) << "never sent";
  client.say(R"({"do": "scene"})");
  EXPECT_TRUE(client.read_until("CMS1", 0.3).empty()) << "asking again opens no second stream";
  EXPECT_EQ(backend.open_scenes, 1);
  client.say(R"({"do": "posed", "sequence": 1})");
  EXPECT_FALSE(client.read_until("CMS1").empty());
  client.say(R"({"do": "no_scene"})");
  client.say(R"({"do": "posed", "sequence": 3})");
  EXPECT_TRUE(client.read_until("CMS1", 0.3).empty()) << "ended";
  EXPECT_EQ(backend.open_scenes, 0);
}

TEST_F(HostileClients, ShareTheGeometryAndItsBound) {
  const std::string first = get("/scene.glb");
  EXPECT_TRUE(starts(first, 200));
  EXPECT_NE(first.find("Content-Type: model/gltf-binary\r\n"), std::string::npos);
  EXPECT_NE(first.find("ETag: \"000000000000abcd\"\r\n"), std::string::npos);
  EXPECT_GE(first.size(), std::size_t{1} << 20U);
  const auto again = [&](const std::string& known) {
    return ask("GET /scene.glb HTTP/1.1\r\n" + host() + "If-None-Match: " + known + "\r\n\r\n");
  };
  EXPECT_TRUE(starts(again("\"000000000000abcd\""), 304));
  EXPECT_TRUE(starts(again("\"000000000000abce\""), 200));
  EXPECT_TRUE(starts(ask("POST /scene.glb HTTP/1.1\r\n" + host() + "Content-Length: 0\r\n\r\n"), 405));
  EXPECT_LT(ask("HEAD /scene.glb HTTP/1.1\r\n" + host() + "\r\n").size(), 2000u);
  backend.keep_waiting = true;
  std::vector<std::unique_ptr<RawClient>> waiting;
  for (std::size_t i = 0; i < kMaxSnapshotsWaiting; ++i) {
    waiting.push_back(std::make_unique<RawClient>(sut->port()));
    waiting.back()->send("GET /scene.glb HTTP/1.1\r\n" + host() + "\r\n");
  }
  const auto asked = [&] {
    const std::scoped_lock lock(backend.mutex);
    return backend.geometries.size();
  };
  const std::size_t before = 4;  // those above
  EXPECT_TRUE(soon([&] { return asked() >= before + kMaxSnapshotsWaiting; }));
  EXPECT_TRUE(starts(get("/scene.glb"), 503));
  EXPECT_TRUE(works());
  backend.keep_waiting = false;
  {
    const std::scoped_lock lock(backend.mutex);
    for (std::size_t i = before; i < backend.geometries.size(); ++i) backend.geometries[i]();
  }
  for (const auto& client : waiting) EXPECT_TRUE(starts(client->read_to_end().value_or(""), 200));
  EXPECT_TRUE(starts(get("/scene.glb"), 200)) << "there is room again";
}

TEST_F(HostileClients, ThatVanishLeaveNothingBehind) {
  {
    RawClient client(sut->port());
    client.open_live(sut->port());
    client.say("{\"do\": \"hello\", \"token\": \""s + kToken + "\"}");
    client.say(R"({"do": "picture"})");
    client.say(R"({"do": "scene"})");
    client.say(R"({"do": "command", "id": 1, "text": "LATER"})");
    client.read_until("CMP1");
  }
  const auto left = [&] { return sut->status().clients > 0 || backend.open_streams > 0 || backend.open_scenes > 0; };
  EXPECT_TRUE(soon([&] { return !left(); }));
  EXPECT_EQ(sut->status().clients, 0u);
  EXPECT_EQ(backend.open_streams, 0);
  EXPECT_EQ(backend.open_scenes, 0);
  for (const auto& reply : backend.held) reply({true, "to nobody"});
  EXPECT_TRUE(works());
  sut.reset();
  for (const auto& reply : backend.held) reply({true, "after the end of the server"});
}

TEST_F(HostileClients, AreNoReasonToEndWhereTheGatewayFails) {
  backend.status_throws = true;
  EXPECT_TRUE(starts(get("/api/status"), 500));
  backend.status_throws = false;
  EXPECT_TRUE(works());
}

TEST_F(HostileClients, ThatWaitForSnapshotsAndPicksDoNotStopTheNews) {
  backend.keep_waiting = true;
  std::vector<std::unique_ptr<RawClient>> waiting;
  for (std::size_t i = 0; i < kMaxSnapshotsWaiting; ++i) {
    waiting.push_back(std::make_unique<RawClient>(sut->port()));
    waiting.back()->send("GET /snapshot.png HTTP/1.1\r\n" + host() + "\r\n");
  }
  const auto asked = [&] {
    const std::scoped_lock lock(backend.mutex);
    return backend.pictures.size();
  };
  EXPECT_TRUE(soon([&] { return asked() >= kMaxSnapshotsWaiting; }));
  ASSERT_EQ(asked(), kMaxSnapshotsWaiting);
  const std::string busy = get("/snapshot.jpg");
  EXPECT_TRUE(starts(busy, 503)) << busy;
  EXPECT_NE(busy.find("Retry-After: 1\r\n"), std::string::npos) << busy;
  EXPECT_EQ(asked(), kMaxSnapshotsWaiting) << "one more was not asked for";
  std::vector<std::unique_ptr<RawClient>> pages;
  for (int i = 0; i < 3; ++i) {
    pages.push_back(std::make_unique<RawClient>(sut->port()));
    pages.back()->open_live(sut->port());
    pages.back()->say(R"({"do": "picture"})");
    pages.back()->say(R"({"do": "pick", "id": 9, "x": 0, "y": 0})");
  }
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(pages.back()->read_until("\"is\":\"live\"").empty()) << i;
  EXPECT_TRUE(works());
  backend.keep_waiting = false;
  {
    const std::scoped_lock lock(backend.mutex);
    for (const auto& give : backend.pictures) give();
    for (const auto& give : backend.picks) give();
  }
  for (const auto& client : waiting) EXPECT_TRUE(starts(client->read_to_end().value_or(""), 200));
  EXPECT_FALSE(pages.back()->read_until("\"is\":\"picked\"").empty());
  EXPECT_TRUE(starts(get("/snapshot.png"), 200)) << "there is room again";
}

TEST_F(HostileClients, CannotCommandAPageThatOnlyShows) {
  start(true);
  RawClient client(sut->port());
  client.open_live(sut->port());
  client.say("{\"do\": \"hello\", \"token\": \""s + kToken + "\"}");
  EXPECT_FALSE(client.read_until("\"read_only\":true").empty());
  client.say(R"({"do": "command", "id": 6, "text": "A"})");
  EXPECT_FALSE(client.read_until("read-only").empty());
  EXPECT_TRUE(backend.commands.empty());
}

TEST_F(HostileClients, CannotHoldUpTheEnd) {
  RawClient stalled(sut->port(), 4096);
  stalled.open_live(sut->port());
  stalled.say(R"({"do": "picture"})");
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  const auto begin = std::chrono::steady_clock::now();
  sut.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10)) << "it would wait for 20 s";
}

TEST(ServerStart, NamesTheRemedyWhereThePortIsTaken) {
  StubBackend backend;
  ServerOptions options;
  options.port = 0;
  const auto first = Server::start(options, backend);
  ASSERT_TRUE(first);
  options.port = (*first)->port();
  const auto second = Server::start(options, backend);
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().text().find("--port"), std::string::npos) << second.error().text();
}

// Resident memory of this process in kB.
long resident_kb() {
  std::ifstream file("/proc/self/statm");
  long pages = 0;
  file >> pages >> pages;
  return pages * 4;
}

// Reads and acknowledges pictures until it has so many; how many it got.
int look(int port, int wanted) {
  RawClient client(port);
  client.open_live(port);
  client.say(R"({"do": "picture", "rate_hz": 60})");
  int pictures = 0;
  while (pictures < wanted && !client.read_until("CMP1").empty()) {
    ++pictures;
    client.say("{\"do\": \"shown\", \"sequence\": " + std::to_string(pictures) + "}");
  }
  return pictures;
}

TEST_F(HostileClients, OneOfEightThatStallsIsCutAndTheOthersGetTheirPictures) {
  constexpr int kPictures = 120;  // in two seconds, if nothing else takes the processors
  start(false, false);
  RawClient stalled(sut->port(), 4096);
  stalled.open_live(sut->port());
  stalled.say(R"({"do": "picture", "rate_hz": 60})");
  const long before = resident_kb();
  std::vector<int> pictures(7);
  std::vector<std::thread> clients;
  for (int& count : pictures) clients.emplace_back([&] { count = look(sut->port(), kPictures); });
  for (std::thread& client : clients) client.join();
  EXPECT_GE(*std::ranges::min_element(pictures), kPictures) << "one was kept from its pictures";
  EXPECT_TRUE(soon([&] { return sut->status().cut >= 1u; })) << "the stalled one, after a second without progress";
  EXPECT_LT(resident_kb() - before, 32 * 1024);
}

}  // namespace
}  // namespace cellmirror::web
