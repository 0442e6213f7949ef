// TF_LOAD of a long program: it is read aside, whoever asked for it waits, and everything else goes on.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "tests/integration/simulate/real_time_owner.hpp"

namespace cellmirror::app {
namespace {

namespace fs = std::filesystem;

// Jumps over its 100,000 records to its end.
std::string long_program() {
  std::string text = "1, HEADER, long\n2, END_HEADER\n5, JUMP, last\n";
  constexpr int kRecords = 100'000;
  for (int n = 10; n < kRecords + 10; ++n) text += fmt::format("{}, DOUT, {}, ON\n", n, 1 + n % 1000);
  return text + fmt::format("{}, LABEL, last\n{}, DOUT, 7, ON\n{}, END\n", 200'000, 200'001, 200'002);
}

class LongLoads : public testing::Test {
 protected:
  void SetUp() override {
    if (source_folder().empty()) GTEST_SKIP() << "skipped: CELLMIRROR_SOURCE_DIR is not set";
    folder_ = fs::temp_directory_path() / fmt::format("cellmirror_long_loads_{}", getpid());
    fs::copy(source_folder() / "config/cells/transfer_cell", folder_, fs::copy_options::recursive);
    std::ofstream(folder_ / "programs/long.ird") << long_program();
    std::ofstream(folder_ / "programs/short.ird") << "1, HEADER, short\n2, END_HEADER\n3, DOUT, 7, OFF\n4, END\n";
    std::ofstream(folder_ / "programs/wrong.ird") << long_program() << "200003, OOPS\n";
    owner_ = std::make_unique<RealTimeOwner>(
        load_cell_for_test(folder_ / "cell.toml"),
        [this](std::int64_t tag, const ScriptReply& reply) {
          const std::scoped_lock lock(mutex_);
          order_.push_back(tag);
          EXPECT_TRUE(replies_.emplace(tag, reply).second) << tag << " was answered twice";
        },
        [this](const program::ProgramEvent& event) {
          const std::scoped_lock lock(mutex_);
          events_.push_back(std::string(name_of(event.kind)) + " " + event.program);
        });
  }
  void TearDown() override {
    owner_.reset();
    std::error_code error;
    fs::remove_all(folder_, error);
  }

  [[nodiscard]] std::size_t answered() {
    const std::scoped_lock lock(mutex_);
    return replies_.size();
  }
  void await_answers(std::size_t count) {
    EXPECT_TRUE(await([&] { return answered() >= count; })) << answered() << " answers";
  }
  void expect_done(std::int64_t tag) { EXPECT_TRUE(replies_.at(tag).done) << tag << ": " << replies_.at(tag).text; }
  void expect_refused(std::int64_t tag, const std::string& why) {
    EXPECT_FALSE(replies_.at(tag).done) << tag;
    EXPECT_NE(replies_.at(tag).text.find(why), std::string::npos) << replies_.at(tag).text;
  }

  fs::path folder_;
  std::mutex mutex_;
  std::vector<std::int64_t> order_;
  std::map<std::int64_t, ScriptReply> replies_;
  std::vector<std::string> events_;
  std::unique_ptr<RealTimeOwner> owner_;
};

TEST_F(LongLoads, KeepNoOtherMessageWaiting) {
  owner_->put(1, "TF_LOAD long MANTEC_R3");
  owner_->put(2, "SET_INPUT MANTEC_R3 3 on");
  owner_->start({});
  await_answers(2);
  expect_done(1);
  expect_done(2);
  EXPECT_EQ(order_, (std::vector<std::int64_t>{2, 1}));
}

TEST_F(LongLoads, AreWaitedForByTheirScript) {
  const std::string script = folder_ / "scripts/long.spt";
  std::ofstream(script) << "TF_LOAD long MANTEC_R3;\nTF_RUN long MANTEC_R3;\nWAIT\n";
  owner_->start(script);
  EXPECT_TRUE(await([&] {
    const std::scoped_lock lock(mutex_);
    return !events_.empty() && events_.back() == "ended long";
  }));
}

TEST_F(LongLoads, KeepTheOrderOfCommandsThatNobodyWaitsFor) {
  owner_->put(1, "TF_LOAD long MANTEC_R3");
  owner_->put(2, "TF_RUN long MANTEC_R3");
  owner_->put(3, "TF_WAIT MANTEC_R3");
  owner_->start({});
  await_answers(3);
  for (const std::int64_t tag : {1, 2, 3}) expect_done(tag);
  EXPECT_EQ(order_.back(), 3);
  EXPECT_EQ(events_.back(), "ended long");
}

TEST_F(LongLoads, BeginBeforeProgramsThatStandBehindThem) {
  owner_->put(1, "TF_LOAD long MANTEC_R3");
  owner_->put(2, "TF_RUN long MANTEC_R3");
  owner_->put(3, "TF_LOAD short MANTEC_R3");
  owner_->put(4, "TF_RUN short MANTEC_R3 exec_wait");
  owner_->put(5, "TF_WAIT MANTEC_R3");
  owner_->start({});
  await_answers(5);
  for (const std::int64_t tag : {1, 2, 3, 4, 5}) expect_done(tag);
  const auto ended = std::ranges::find(events_, "ended long");
  EXPECT_NE(std::find(ended, events_.end(), "started short"), events_.end());
}

TEST_F(LongLoads, AreLoadedAndDoNotRunAfterTfStop) {
  owner_->put(1, "TF_LOAD long MANTEC_R3");
  owner_->put(2, "TF_RUN long MANTEC_R3");
  owner_->put(3, "TF_STOP MANTEC_R3");
  owner_->start({});
  await_answers(3);
  expect_done(1);
  expect_refused(2, "TF_STOP");
  expect_done(3);
}

TEST_F(LongLoads, AreLoadedAndDoNotRunAfterStopRob) {
  owner_->put(1, "TF_LOAD long MANTEC_R3");
  owner_->put(2, "TF_RUN long MANTEC_R3");
  owner_->put(3, "STOP_ROB MANTEC_R3");
  owner_->start({});
  await_answers(3);
  expect_done(1);
  expect_refused(2, "STOP_ROB");
  expect_done(3);
}

TEST_F(LongLoads, BeginHeldAfterTfHold) {
  owner_->put(1, "TF_LOAD long MANTEC_R3");
  owner_->put(2, "TF_RUN long MANTEC_R3");
  owner_->put(3, "TF_HOLD MANTEC_R3");
  owner_->start({});
  await_answers(3);
  for (const std::int64_t tag : {1, 2, 3}) expect_done(tag);
  owner_->put(4, "TF_RESUME MANTEC_R3");
  owner_->put(5, "TF_WAIT MANTEC_R3");
  await_answers(5);
  for (const std::int64_t tag : {4, 5}) expect_done(tag);
  ASSERT_GE(events_.size(), 2U);
  EXPECT_EQ(events_[0], "started long");
  EXPECT_EQ(events_[1], "held long");
  EXPECT_EQ(events_.back(), "ended long");
}

TEST_F(LongLoads, GiveUpOnlyTheirOwnRunsByTfDelete) {
  owner_->put(1, "TF_LOAD short MANTEC_R3");
  owner_->put(2, "TF_LOAD long MANTEC_R3");
  owner_->put(3, "TF_RUN long MANTEC_R3");
  owner_->put(4, "TF_RUN short MANTEC_R3 exec_wait");
  owner_->put(5, "TF_DELETE long MANTEC_R3");
  owner_->start({});
  await_answers(5);
  expect_refused(3, "TF_DELETE");
  expect_done(4);
}

TEST_F(LongLoads, AreRefusedWithTheirFaultsAndSoIsWhatWaitedForThem) {
  owner_->put(1, "TF_LOAD wrong MANTEC_R3");
  owner_->put(2, "TF_RUN wrong MANTEC_R3");
  owner_->start({});
  await_answers(2);
  expect_refused(1, "programs/wrong.ird has 1 error");
  expect_refused(2, "programs/wrong.ird has 1 error");
}

TEST_F(LongLoads, AreGivenUpByTfDelete) {
  owner_->put(1, "TF_LOAD long MANTEC_R3");
  owner_->put(2, "TF_RUN long MANTEC_R3");
  owner_->put(3, "TF_DELETE long MANTEC_R3");
  owner_->put(4, "TF_RUN long MANTEC_R3");
  owner_->start({});
  await_answers(4);
  expect_refused(1, "TF_DELETE");
  expect_refused(2, "TF_DELETE");
  expect_done(3);
  expect_refused(4, "no program is loaded");
}

TEST_F(LongLoads, AreRefusedWhereTheirRobotIsDeletedMeanwhile) {
  owner_->put(1, "TF_LOAD long mantec_R3a");
  owner_->put(2, "DELETE_NODE Mantec_4");
  owner_->start({});
  await_answers(2);
  expect_done(2);
  expect_refused(1, "mantec_R3a");
}

TEST_F(LongLoads, AreAnsweredOnceWhenTheGatewayEnds) {
  constexpr std::int64_t kLoads = 40;
  for (std::int64_t tag = 1; tag <= kLoads; ++tag) owner_->put(tag, "TF_LOAD long MANTEC_R3");
  owner_->put(kLoads + 1, "SET_INPUT MANTEC_R3 3 on");
  owner_->start({});
  EXPECT_TRUE(await([&] {
    const std::scoped_lock lock(mutex_);
    return replies_.contains(kLoads + 1);
  }));
  owner_->stop();
  ASSERT_EQ(replies_.size(), static_cast<std::size_t>(kLoads + 1));
  for (std::int64_t tag = 1; tag <= kLoads; ++tag) {
    if (!replies_.at(tag).done) expect_refused(tag, "the gateway ends");
  }
}

}  // namespace
}  // namespace cellmirror::app
