// The server of the Foxglove protocol with topics of a test: a client that does not keep up.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <memory>
#include <string>
#include <thread>

#include "ipc/web/live_data.hpp"
#include "ipc/web/web_server.hpp"
#include "tests/integration/web/raw_client.hpp"
#include "tests/integration/web/stub_backend.hpp"

namespace cellmirror::web {
namespace {

class StubData final : public LiveData {
 public:
  [[nodiscard]] foxglove::TopicFeed& feed() override { return topics; }
  [[nodiscard]] std::vector<foxglove::Parameter> parameters() override { throw std::runtime_error("on purpose"); }
  void set_parameter(const foxglove::Parameter& /*parameter*/, const CommandOrigin& /*origin*/,
                     std::function<void(const Result<void>&)> reply) override {
    reply({});
  }
  [[nodiscard]] Result<std::string> asset(std::string_view uri) override {
    if (uri == "throws") throw std::runtime_error("on purpose");
    return std::string(kMaxAssetBytes, 'a');
  }

  foxglove::TopicFeed topics;
};

class BackendWithData final : public StubBackend {
 public:
  [[nodiscard]] LiveData* live_data() override { return &data; }
  StubData data;
};

constexpr foxglove::ChannelView kFat = {"/fat", "json", "a", "{}", "jsonschema", 4};
constexpr foxglove::ChannelView kThin = {"/thin", "json", "a", "{}", "jsonschema", 16};

class FoxgloveServer : public testing::Test {
 protected:
  void SetUp() override {
    backend_.data.topics.wants(kFat);
    backend_.data.topics.wants(kThin);
    ServerOptions options;
    options.port = 0;
    options.token = "0123456789abcdef0123456789abcdef";
    auto started = Server::start(options, backend_);
    ASSERT_TRUE(started) << started.error().text();
    sut_ = std::move(*started);
  }

  std::unique_ptr<RawClient> connect() {
    auto client = std::make_unique<RawClient>(sut_->port(), 16 * 1024);
    const std::string head = client->open_foxglove(sut_->port());
    EXPECT_TRUE(head.starts_with("HTTP/1.1 101")) << head;
    EXPECT_TRUE(client->next_message().text.contains("serverInfo"));
    return client;
  }
  static bool soon(const std::function<bool()>& condition) {
    for (int i = 0; i < 6000; ++i) {
      if (condition()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }

  BackendWithData backend_;
  std::unique_ptr<Server> sut_;
};

// The client reads 64 KiB at a time, with pauses; the fat topic has a megabyte a message, a hundred times a second.
TEST_F(FoxgloveServer, AFatTopicDoesNotDelayAThinOneOfASlowClient) {
  const auto client = connect();
  client->say(R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":1},{"id":2,"channelId":2}]})");
  ASSERT_TRUE(soon([&] { return backend_.data.topics.status().channels.size() == 2; }));
  std::atomic<std::uint64_t> number{0};
  std::jthread source([&](const std::stop_token& stop) {
    const std::string fat(1'000'000, 'f');
    while (!stop.stop_requested()) {
      backend_.data.topics.put(kThin, ++number, "thin");
      backend_.data.topics.put(kFat, number, fat);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  });
  // Between two thin messages that arrive there is one fat message at most: as soon as one is through, it is the thin
  // topic's turn.
  int fat = 0;
  int fat_between = 0;
  int thin = 0;
  const auto left_out = [&] { return backend_.data.topics.status().channels[0].dropped > 0; };
  while (fat < 12 || (fat < 100 && !left_out())) {
    const ServerMessage message = client->next_message(std::chrono::milliseconds(2));
    ASSERT_FALSE(message.ended);
    if (message.opcode != 2 || message.text.front() != 1) continue;
    if (message.text[1] == 1) {
      ++fat;
      EXPECT_LE(++fat_between, 1);
    } else {
      ++thin;
      fat_between = 0;
    }
  }
  source.request_stop();
  source.join();
  EXPECT_GE(thin, fat - 1);
  const auto topics = backend_.data.topics.status().channels;
  EXPECT_GT(topics[0].dropped, 0U) << "the client was slow";
  EXPECT_EQ(topics[0].topic, "/fat");
  // The client is told.
  for (int i = 0; i < 200; ++i) {
    const ServerMessage message = client->next_message();
    ASSERT_FALSE(message.ended);
    if (message.opcode == 1 && message.text.contains("left out")) {
      EXPECT_TRUE(message.text.contains("/fat")) << message.text;
      return;
    }
  }
  FAIL() << "no status of what was left out";
}

TEST_F(FoxgloveServer, LargeFilesComeOneAfterTheOtherAndFailuresAreTold) {
  const auto client = connect();
  for (int i = 1; i <= 3; ++i)
    client->say(R"({"op":"fetchAsset","uri":")" + std::string(i == 2 ? "throws" : "a") + R"(","requestId":)" +
                std::to_string(i) + "}");
  std::string order;
  while (order.size() < 3) {
    const ServerMessage message = client->next_message();
    ASSERT_FALSE(message.ended);
    if (message.opcode != 2 || message.text.front() != 4) continue;
    order += static_cast<char>('0' + message.text[1]);
    if (message.text[1] == 2) {
      EXPECT_TRUE(message.text.contains("on purpose"));
    } else {
      EXPECT_EQ(message.text.size(), 10 + kMaxAssetBytes);
    }
  }
  EXPECT_EQ(order, "123");
  // A gateway whose parameters fail goes on.
  client->say(R"({"op":"getParameters","parameterNames":[],"id":"x"})");
  for (;;) {
    const ServerMessage message = client->next_message();
    ASSERT_FALSE(message.ended);
    if (message.text.contains("parameterValues")) break;
  }
}

TEST_F(FoxgloveServer, AClientThatIsGoneLeavesNothing) {
  {
    const auto client = connect();
    client->say(R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":2}]})");
    ASSERT_TRUE(soon([&] { return backend_.data.topics.wants(kThin); }));
  }
  EXPECT_TRUE(soon([&] { return backend_.data.topics.clients() == 0; }));
  EXPECT_FALSE(backend_.data.topics.wants(kThin));
  backend_.data.topics.put(kThin, 1, "x");
  EXPECT_TRUE(soon([&] { return sut_->status().clients == 0; }));
}

}  // namespace
}  // namespace cellmirror::web
