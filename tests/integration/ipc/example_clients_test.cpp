// The clients of docs/examples as real processes against a gateway process.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "ipc/sysv/script_client.hpp"
#include "tests/integration/ipc/child_process.hpp"
#include "tests/integration/ipc/own_ipc.hpp"

namespace cellmirror {
namespace {

using test::ChildProcess;
using test::own_queues;
using test::queue_exists;

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}
std::string program(const char* name) { return environment("CELLMIRROR_BIN_DIR") + "/" + name; }
std::string example(const char* name) { return environment("CELLMIRROR_SOURCE_DIR") + "/docs/examples/" + name; }

struct Language {
  const char* name;
  std::vector<std::string> sender;
  std::vector<std::string> reader;
};

std::vector<Language> languages() {
  // -B: no __pycache__ in the sources.
  return {{"C", {program("ipc_example_send_command")}, {program("ipc_example_sensor_reader")}},
          {"Perl", {"perl", example("send_command.pl")}, {"perl", example("sensor_reader.pl")}},
          {"Python",
           {"/usr/bin/python3", "-B", example("send_command.py")},
           {"/usr/bin/python3", "-B", example("sensor_reader.py")}}};
}

std::vector<std::string> joined(std::vector<std::string> words, const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

class ExampleClients : public ::testing::TestWithParam<Language> {
 protected:
  void SetUp() override {
    if (environment("CELLMIRROR_BIN_DIR").empty()) GTEST_SKIP() << "skipped: CELLMIRROR_BIN_DIR is not set, use ctest";
  }
  std::vector<std::string> gateway_command(const std::string& rate_hz = "0") {
    return {program("ipc_test_gateway"), std::to_string(queues_.script_key), std::to_string(queues_.sensor_key),
            std::to_string(queues_.reply_key), rate_hz};
  }
  std::vector<std::string> send(const std::string& command, const std::string& timeout = "60") {
    return joined(GetParam().sender, {"--script-key", std::to_string(queues_.script_key), "--reply-key",
                                      std::to_string(queues_.reply_key), "--timeout", timeout, command});
  }
  std::vector<std::string> read(const std::string& count, const std::string& timeout) {
    return joined(GetParam().reader,
                  {"--key", std::to_string(queues_.sensor_key), "--count", count, "--timeout", timeout});
  }
  QueueConfig queues_ = own_queues();
};

TEST_P(ExampleClients, SendsAndGetsDone) {
  ChildProcess gateway(gateway_command());
  ASSERT_EQ(gateway.line(), "ready");
  ChildProcess sut(send("echo two words"));
  EXPECT_EQ(sut.wait(), 0) << sut.errors();
  EXPECT_EQ(sut.output(), "done two words\n");
  EXPECT_EQ(gateway.end(SIGTERM), 0) << gateway.errors();
}

TEST_P(ExampleClients, SendsAndIsRefused) {
  ChildProcess gateway(gateway_command());
  ASSERT_EQ(gateway.line(), "ready");
  ChildProcess sut(send("nonsense"));
  EXPECT_EQ(sut.wait(), 1);
  EXPECT_EQ(sut.output(), "refused unknown command; try echo\n");
}

TEST_P(ExampleClients, EndsInTimeWithoutAnAnswer) {
  ChildProcess gateway(gateway_command());
  ASSERT_EQ(gateway.line(), "ready");
  ChildProcess sut(send("silent", "0.2"));
  EXPECT_EQ(sut.wait(), 1);
  EXPECT_NE(sut.errors().find("no answer in time"), std::string::npos) << sut.errors();
}

TEST_P(ExampleClients, TellsThatThereIsNoGateway) {
  ChildProcess sender(send("echo x"));
  EXPECT_EQ(sender.wait(), 1);
  EXPECT_NE(sender.errors().find("no gateway is running"), std::string::npos) << sender.errors();
  ChildProcess reader(read("1", "1"));
  EXPECT_EQ(reader.wait(), 1);
  EXPECT_NE(reader.errors().find("no gateway is running"), std::string::npos) << reader.errors();
}

TEST_P(ExampleClients, ReadsRecords) {
  ChildProcess gateway(gateway_command("200"));
  ASSERT_EQ(gateway.line(), "ready");
  ChildProcess sut(read("5", "60"));
  EXPECT_EQ(sut.wait(), 0) << sut.errors();
  // The gateway's step is the record's number, and the position 0.25 times that, modulo 8.
  int lines = 0;
  std::size_t at = 0;
  for (std::size_t end; (end = sut.output().find('\n', at)) != std::string::npos; at = end + 1, ++lines) {
    const std::string line = sut.output().substr(at, end - at);
    const double position = 0.25 * static_cast<double>(std::stoull(line) % 8);
    char expected[200];
    std::snprintf(expected, sizeof expected,
                  "%llu PUMA_762 online fresh J_1=%.6f J_2=%.6f tcp 1.000000 -2.000000 0.125000", std::stoull(line),
                  position, -position);
    EXPECT_EQ(line, expected);
  }
  EXPECT_EQ(lines, 5);
}

TEST_P(ExampleClients, ReadsWhatSensorsCollisionTestsCamerasAndTissueReport) {
  ChildProcess gateway(gateway_command("findings"));
  ASSERT_EQ(gateway.line(), "ready");
  ChildProcess sut(read("13", "60"));
  EXPECT_EQ(sut.wait(), 0) << sut.errors();
  EXPECT_EQ(sut.output(),
            "1 range USS_1 0.250000 cell.box\n"
            "2 range USS_2 nothing\n"
            "3 range USS_3 blind cell.box\n"
            "4 range USS_4 doubt\n"
            "5 ranges 1/1 USS_1=0.250000 USS_2=nothing USS_3=blind USS_4=doubt\n"
            "6 event 1 touched cell.A cell.B 0.000000\n"
            "7 proximity touching 1 warning 2 of 45 pairs: cell.A|cell.B=touching cell.B|cell.C=0.012500\n"
            "8 camera UMG_Kamera_1 tracks Gantry.J_2.Hand mirrored pan 0.250000 tilt -0.500000 distance 4.000000 "
            "fovy 0.750000\n"
            "9 camera CAMERA_5 free simulated pan 0.250000 tilt -0.500000 distance 4.000000 fovy 0.750000\n"
            "10 tissue 1 clip APPLIER liver cystic_artery 0.062500 at 0.125000 -0.500000 1.000000\n"
            "11 tissue 2 bleed - liver - 12.500000 at 0.000000 0.000000 0.000000\n"
            "12 barrier gate free 0 -\n"
            "13 barrier door interrupted 3 cell.A\n");
}

TEST_P(ExampleClients, ReaderEndsInTimeWithoutRecords) {
  ChildProcess gateway(gateway_command());
  ASSERT_EQ(gateway.line(), "ready");
  ChildProcess sut(read("1", "1"));
  EXPECT_EQ(sut.wait(), 1);
  EXPECT_NE(sut.errors().find("no record in time"), std::string::npos) << sut.errors();
}

TEST_P(ExampleClients, HelpAndWrongUsage) {
  for (const auto& client : {GetParam().sender, GetParam().reader}) {
    ChildProcess help(joined(client, {"--help"}));
    EXPECT_EQ(help.wait(), 0);
    EXPECT_NE(help.output().find("usage: "), std::string::npos);
    ChildProcess wrong(joined(client, {"--nonsense"}));
    EXPECT_EQ(wrong.wait(), 2);
    EXPECT_NE(wrong.errors().find("usage: "), std::string::npos);
  }
}

INSTANTIATE_TEST_SUITE_P(Languages, ExampleClients, ::testing::ValuesIn(languages()),
                         [](const auto& case_info) { return std::string(case_info.param.name); });

std::vector<std::string> gateway_on(const QueueConfig& queues, const std::string& rate_hz) {
  return {program("ipc_test_gateway"), std::to_string(queues.script_key), std::to_string(queues.sensor_key),
          std::to_string(queues.reply_key), rate_hz};
}

TEST(GatewayProcess, KilledAtAnyMomentTheNextStartWorks) {
  if (environment("CELLMIRROR_BIN_DIR").empty()) GTEST_SKIP() << "skipped: CELLMIRROR_BIN_DIR is not set, use ctest";
  const QueueConfig queues = own_queues();
  for (int i = 0; i < 50; ++i) {
    ChildProcess gateway(gateway_on(queues, "1000"));
    if (i % 2 == 0) {
      ASSERT_EQ(gateway.line(), "ready");
    }
    if (i % 4 == 0) {
      ASSERT_TRUE(send_command(queues, "echo x", Nanoseconds{60'000'000'000}));
    }
    // Otherwise somewhere in its start.
    if (i % 2 == 1) ::usleep(static_cast<useconds_t>(i * 50));
    gateway.end(SIGKILL);
  }
  ChildProcess last(gateway_on(queues, "0"));
  ASSERT_EQ(last.line(), "ready") << last.errors();
  EXPECT_EQ(last.end(SIGTERM), 0);
  for (const std::int32_t key : {queues.script_key, queues.sensor_key, queues.reply_key}) {
    EXPECT_FALSE(queue_exists(key));
  }
}

TEST(GatewayProcess, SecondOneOnTheSameKeysIsRefused) {
  if (environment("CELLMIRROR_BIN_DIR").empty()) GTEST_SKIP() << "skipped: CELLMIRROR_BIN_DIR is not set, use ctest";
  const QueueConfig queues = own_queues();
  ChildProcess first(gateway_on(queues, "0"));
  ASSERT_EQ(first.line(), "ready");
  ChildProcess second(gateway_on(queues, "0"));
  EXPECT_EQ(second.wait(), 1);
  EXPECT_NE(second.errors().find("in use by process " + std::to_string(first.pid())), std::string::npos)
      << second.errors();
  EXPECT_EQ(send_command(queues, "echo still here", Nanoseconds{60'000'000'000})->text, "still here");
}

}  // namespace
}  // namespace cellmirror
