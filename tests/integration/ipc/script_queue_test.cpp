// Commands in and replies out, between this process's client and receiver.
#include <gtest/gtest.h>
#include <sys/msg.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <mutex>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "ipc/sysv/script_client.hpp"
#include "ipc/sysv/script_message_receiver.hpp"
#include "tests/integration/ipc/own_ipc.hpp"

namespace cellmirror {
namespace {

using namespace std::chrono_literals;
using test::own_queues;
using test::queue_exists;
using test::remove_queue;

constexpr Nanoseconds kLong{60'000'000'000};
constexpr Nanoseconds kShort{50'000'000};

// What the handler was given.
class Inbox {
 public:
  void put(ScriptMessage message) {
    const std::lock_guard guard(mutex_);
    messages_.push_back(std::move(message));
    came_.notify_all();
  }
  ScriptMessage next() {
    std::unique_lock lock(mutex_);
    if (!came_.wait_for(lock, 60s, [this] { return !messages_.empty(); })) return {"nothing came", 0, 0};
    ScriptMessage message = std::move(messages_.front());
    messages_.pop_front();
    return message;
  }
  [[nodiscard]] std::size_t waiting() {
    const std::lock_guard guard(mutex_);
    return messages_.size();
  }

 private:
  std::mutex mutex_;
  std::condition_variable came_;
  std::deque<ScriptMessage> messages_;
};

// As a program sends that has nothing but msgsnd.
int raw_send(std::int32_t key, long type, std::string_view text, int flags = 0) {
  struct {
    long type;
    char text[8192];
  } message;
  message.type = type;
  std::memcpy(message.text, text.data(), text.size());
  return ::msgsnd(::msgget(key, 0), &message, text.size(), flags);
}

std::string raw_receive(std::int32_t key, long type) {
  struct {
    long type;
    char text[8192];
  } message;
  const ssize_t got = ::msgrcv(::msgget(key, 0), &message, sizeof message.text, type, 0);
  return got < 0 ? "error" : std::string(message.text, static_cast<std::size_t>(got));
}

// A receiver that gathers what comes in an inbox.
class ScriptQueue : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto started = sut_.start([this](ScriptMessage message) { inbox_.put(std::move(message)); });
    ASSERT_TRUE(started) << started.error().text();
  }
  // All that was sent before has been handled when this command arrives.
  void flush() {
    ASSERT_EQ(raw_send(queues_.script_key, 5, "flush"), 0);
    while (inbox_.next().text != "flush") {
    }
  }

  QueueConfig queues_ = own_queues();
  Inbox inbox_;
  ScriptMessageReceiver sut_{queues_, "test"};
};

TEST_F(ScriptQueue, HandsPlainCommandsOn) {
  ASSERT_EQ(raw_send(queues_.script_key, 5, std::string_view("ROBACT PUMA_762\0", 16)), 0);
  const ScriptMessage message = inbox_.next();
  EXPECT_EQ(message.text, "ROBACT PUMA_762");
  EXPECT_EQ(message.tag, 0);
  EXPECT_EQ(message.sender_pid, ::getpid());
  EXPECT_EQ(sut_.status().received, 1u);
}

TEST_F(ScriptQueue, RepliesToTheTag) {
  ASSERT_EQ(raw_send(queues_.script_key, 5, "@77 ROBACT X"), 0);
  const ScriptMessage message = inbox_.next();
  EXPECT_EQ(message.tag, 77);
  sut_.reply(message.tag, {false, "unknown robot X"});
  EXPECT_EQ(raw_receive(queues_.reply_key, 77), "refused unknown robot X");
  sut_.reply(0, {true, ""});
  EXPECT_EQ(sut_.status().replies, 1u) << "tag 0 asks for none";
}

TEST_F(ScriptQueue, MalformedMessageWithATagIsToldSo) {
  ASSERT_EQ(raw_send(queues_.script_key, 5, "@78 ROB\x02"), 0);
  EXPECT_TRUE(raw_receive(queues_.reply_key, 78).starts_with("refused byte 8 of the message"));
  const ScriptMessageStatus status = sut_.status();
  EXPECT_EQ(status.malformed, 1u);
  EXPECT_EQ(status.received, 0u);
  ASSERT_EQ(status.last_errors.size(), 1u);
}

TEST_F(ScriptQueue, OtherTypesAndNoiseDoNotClogTheQueue) {
  std::mt19937 random(7);
  std::string noise(8192, '\0');
  for (char& c : noise) c = static_cast<char>(1 + random() % 255);
  for (int i = 0; i < 10; ++i) {
    ASSERT_EQ(raw_send(queues_.script_key, 6, noise), 0);
    ASSERT_EQ(raw_send(queues_.script_key, 5, noise), 0);
    ASSERT_EQ(raw_send(queues_.script_key, 1'000'000, ""), 0);
  }
  flush();
  const ScriptMessageStatus status = sut_.status();
  EXPECT_EQ(status.wrong_type, 20u);
  EXPECT_EQ(status.malformed, 10u);
  EXPECT_EQ(status.received, 1u);
  EXPECT_EQ(status.waiting, 0u);
  EXPECT_LE(status.last_errors.size(), 16u);
}

TEST_F(ScriptQueue, OrderIsKept) {
  for (int i = 0; i < 500; ++i) ASSERT_EQ(raw_send(queues_.script_key, 5, "echo " + std::to_string(i)), 0);
  for (int i = 0; i < 500; ++i) EXPECT_EQ(inbox_.next().text, "echo " + std::to_string(i));
}

TEST_F(ScriptQueue, FullReplyQueueLosesItsOldest) {
  const std::string text(1000, 'x');
  for (int tag = 1; tag <= 100; ++tag) sut_.reply(tag, {true, text + std::to_string(tag)});
  EXPECT_EQ(sut_.status().replies, 100u);
  EXPECT_GE(sut_.status().replies_dropped, 80u);
  EXPECT_EQ(raw_receive(queues_.reply_key, 100), "done " + text + "100") << "the newest is there";
}

TEST_F(ScriptQueue, InputQueueRemovedFromOutsideComesBack) {
  remove_queue(queues_.script_key);
  // The receiver is told by the kernel; how long that takes does not matter.
  for (int i = 0; i < 60'000 && !queue_exists(queues_.script_key); ++i) std::this_thread::sleep_for(1ms);
  ASSERT_EQ(raw_send(queues_.script_key, 5, "DRAW_SCENE"), 0);
  EXPECT_EQ(inbox_.next().text, "DRAW_SCENE");
  EXPECT_EQ(sut_.status().recreated, 1u);
}

TEST_F(ScriptQueue, ReplyQueueRemovedFromOutsideComesBackBeforeTheReply) {
  remove_queue(queues_.reply_key);
  std::thread executor([this] {
    const ScriptMessage message = inbox_.next();
    sut_.reply(message.tag, {true, "back"});
  });
  const auto reply = send_command(queues_, "DRAW_SCENE", kLong);
  executor.join();
  ASSERT_TRUE(reply) << reply.error().text();
  EXPECT_EQ(reply->text, "back");
  EXPECT_EQ(sut_.status().recreated, 1u);
}

TEST_F(ScriptQueue, BothQueuesRemovedAgainAndAgain) {
  for (int i = 0; i < 20; ++i) {
    remove_queue(queues_.reply_key);
    remove_queue(queues_.script_key);
    for (int j = 0; j < 60'000 && !queue_exists(queues_.script_key); ++j) std::this_thread::sleep_for(1ms);
    ASSERT_EQ(raw_send(queues_.script_key, 5, "n" + std::to_string(i)), 0);
    EXPECT_EQ(inbox_.next().text, "n" + std::to_string(i));
  }
}

TEST_F(ScriptQueue, ClientGetsDoneAndRefused) {
  std::thread executor([this] {
    for (int i = 0; i < 2; ++i) {
      const ScriptMessage message = inbox_.next();
      sut_.reply(message.tag, {message.text == "good", message.text == "good" ? "" : "bad command"});
    }
  });
  EXPECT_EQ(send_command(queues_, "good", kLong), (ScriptReply{true, ""}));
  EXPECT_EQ(send_command(queues_, "bad", kLong), (ScriptReply{false, "bad command"}));
  executor.join();
}

TEST_F(ScriptQueue, ClientEndsInTimeWithoutAnAnswer) {
  const auto reply = send_command(queues_, "silent", kShort);
  ASSERT_FALSE(reply);
  EXPECT_NE(reply.error().what.find("did not answer within 0.05 s"), std::string::npos) << reply.error().text();
  EXPECT_NE(reply.error().what.find("may still be executed"), std::string::npos);
  EXPECT_EQ(reply.error().what.find("no gateway"), std::string::npos);
}

TEST_F(ScriptQueue, ManyClientsGetTheirOwnReplies) {
  constexpr int kClients = 8;
  constexpr int kCommands = 50;
  std::thread executor([this] {
    for (int i = 0; i < kClients * kCommands; ++i) {
      const ScriptMessage message = inbox_.next();
      sut_.reply(message.tag, {true, message.text});
    }
  });
  std::vector<pid_t> children;
  for (int c = 0; c < kClients; ++c) {
    const pid_t child = ::fork();
    if (child == 0) {
      for (int i = 0; i < kCommands; ++i) {
        const std::string text = std::to_string(c) + " " + std::to_string(i);
        const auto reply = send_command(queues_, text, kLong);
        if (!reply || reply->text != text) _exit(1);
      }
      _exit(0);
    }
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = 1;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
  }
  executor.join();
}

TEST_F(ScriptQueue, StopEndsTheWaitAndRemovesBothQueues) {
  sut_.stop();
  EXPECT_FALSE(queue_exists(queues_.script_key));
  EXPECT_FALSE(queue_exists(queues_.reply_key));
  sut_.reply(5, {true, ""});
  sut_.stop();
  EXPECT_TRUE(sut_.start([this](ScriptMessage message) { inbox_.put(std::move(message)); })) << "it may start again";
}

TEST_F(ScriptQueue, SecondGatewayOnTheSameKeysIsRefused) {
  ScriptMessageReceiver second(queues_, "second");
  const auto started = second.start([](const ScriptMessage&) {});
  ASSERT_FALSE(started);
  EXPECT_NE(started.error().what.find("instance test"), std::string::npos) << started.error().text();
  EXPECT_TRUE(queue_exists(queues_.script_key));
  EXPECT_TRUE(queue_exists(queues_.reply_key));
}

TEST(ScriptQueueStart, LeavesNothingBehindWhereOneQueueIsRefused) {
  const QueueConfig queues = own_queues();
  ASSERT_GE(test::make_queue(queues.script_key, 0666), 0);
  ScriptMessageReceiver sut(queues, "test");
  EXPECT_FALSE(sut.start([](const ScriptMessage&) {}));
  EXPECT_FALSE(queue_exists(queues.reply_key));
  remove_queue(queues.script_key);
  EXPECT_TRUE(sut.start([](const ScriptMessage&) {}));
}

TEST(ScriptQueueFull, IsTheSendersToSee) {
  const QueueConfig queues = own_queues();
  std::mutex hold;
  std::unique_lock held(hold);
  std::atomic<int> handled{0};
  ScriptMessageReceiver sut(queues, "test");
  ASSERT_TRUE(sut.start([&](const ScriptMessage&) {
    const std::lock_guard wait(hold);
    ++handled;
  }));
  int sent = 0;
  // The handler keeps one; the rest fills the queue.
  while (sent < 100'000 && raw_send(queues.script_key, 5, "DRAW_SCENE", IPC_NOWAIT) == 0) ++sent;
  EXPECT_EQ(errno, EAGAIN);
  const auto reply = send_command(queues, "DRAW_SCENE", kShort);
  ASSERT_FALSE(reply);
  EXPECT_NE(reply.error().what.find("stayed full"), std::string::npos) << reply.error().text();
  held.unlock();
  for (int i = 0; i < 60'000 && handled < sent; ++i) std::this_thread::sleep_for(1ms);
  EXPECT_EQ(handled, sent) << "nothing was lost";
}

TEST(ScriptClient, TellsThatThereIsNoGateway) {
  const auto reply = send_command(own_queues(), "DRAW_SCENE", kShort);
  ASSERT_FALSE(reply);
  EXPECT_NE(reply.error().what.find("no gateway is running"), std::string::npos);
  EXPECT_NE(reply.error().remedy.find("cellmirror run"), std::string::npos);
}

TEST(ScriptClient, TellsThatTheGatewayEnded) {
  const QueueConfig queues = own_queues();
  ScriptMessageReceiver gateway(queues, "test");
  Inbox inbox;
  ASSERT_TRUE(gateway.start([&](ScriptMessage message) { inbox.put(std::move(message)); }));
  std::thread ending([&] {
    inbox.next();
    std::this_thread::sleep_for(20ms);  // the client may wait by then; it must notice in both cases
    gateway.stop();
  });
  const auto reply = send_command(queues, "DRAW_SCENE", kLong);
  ending.join();
  ASSERT_FALSE(reply);
}

TEST(ScriptClient, RecognizesAQueueWithoutAGateway) {
  const QueueConfig queues = own_queues();
  ASSERT_GE(test::make_queue(queues.script_key, 0600), 0);
  ASSERT_GE(test::make_queue(queues.reply_key, 0600), 0);
  const auto reply = send_command(queues, "DRAW_SCENE", kShort);
  ASSERT_FALSE(reply);
  EXPECT_NE(reply.error().what.find("no gateway of this user holds the queue"), std::string::npos)
      << reply.error().text();
  remove_queue(queues.script_key);
  remove_queue(queues.reply_key);
}

TEST(ScriptClient, TooLongACommandIsRefusedBeforeItIsSent) {
  const QueueConfig queues = own_queues();
  ScriptMessageReceiver gateway(queues, "test");
  ASSERT_TRUE(gateway.start([](const ScriptMessage&) {}));
  const auto reply = send_command(queues, std::string(8192, 'x'), kShort);
  ASSERT_FALSE(reply);
  EXPECT_NE(reply.error().remedy.find("EXEC_SCRIPT"), std::string::npos);
}

}  // namespace
}  // namespace cellmirror
