// Partitions: cells whose robots have the same names share a domain, and the summary is outside of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <mutex>
#include <string>
#include <vector>

#include "cyclone_peer.hpp"
#include "drivers/dds/dds_stream.hpp"
#include "drivers/dds/joint_state_publisher.hpp"
#include "drivers/dds/summary_output.hpp"
#include "drivers/dds/summary_reader.hpp"
#include "ipc/wire/cell_summary_text.hpp"
#include "own_network.hpp"
#include "waiting.hpp"

namespace cellmirror::dds::test {
namespace {

std::unique_ptr<JointStatePublisher> publisher(const std::string& partition) {
  auto made = JointStatePublisher::make({.domain = test_domain(6), .topic = "rt/parted", .partition = partition});
  EXPECT_TRUE(made) << made.error().text();
  return std::move(*made);
}

TEST(DdsPartitionTest, AStreamReadsThePublisherOfItsPartitionAlone) {
  const SystemClock clock;
  const auto left = publisher("left");
  const auto right = publisher("right");
  const auto none = publisher("");
  DdsStreamConfig config;
  config.domain = test_domain(6);
  config.topic = "rt/parted";
  config.joints = {{"a", 0, 1.0, 0.0}};
  config.partition = "right";
  auto sut = make_dds_stream(config, clock, {});
  ASSERT_TRUE(sut) << sut.error().text();
  CollectingSink sink;
  ASSERT_TRUE((*sut)->open(sink));
  ASSERT_TRUE(eventually([&] { return right->matched_readers() == 1; }));
  ASSERT_TRUE(eventually([&] {
    left->publish({.name = {"a"}, .position = {1}});
    none->publish({.name = {"a"}, .position = {2}});
    right->publish({.name = {"a"}, .position = {3}});
    return sink.size() >= 20;
  }));
  for (const JointSample& sample : sink.samples()) EXPECT_EQ(sample.position[0], 3);
  EXPECT_EQ(left->matched_readers(), 0);
  EXPECT_EQ(none->matched_readers(), 0);
  (*sut)->close();
}

class Inbox final : public SummaryInbox {
 public:
  void received(const ReceivedSummary& summary) override {
    const std::scoped_lock lock(mutex_);
    received_.push_back(summary);
  }
  void rejected(std::string_view /*sender*/, const std::string& why) override {
    const std::scoped_lock lock(mutex_);
    rejected_.push_back(why);
  }
  void gone(std::string_view sender) override {
    const std::scoped_lock lock(mutex_);
    gone_.emplace_back(sender);
  }
  [[nodiscard]] std::vector<ReceivedSummary> received() const {
    const std::scoped_lock lock(mutex_);
    return received_;
  }
  [[nodiscard]] std::vector<std::string> rejected() const {
    const std::scoped_lock lock(mutex_);
    return rejected_;
  }
  [[nodiscard]] std::vector<std::string> gone() const {
    const std::scoped_lock lock(mutex_);
    return gone_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<ReceivedSummary> received_;
  std::vector<std::string> rejected_;
  std::vector<std::string> gone_;
};

class DdsSummaryTest : public testing::Test {
 protected:
  [[nodiscard]] std::unique_ptr<SummaryOutput> output(const std::string& partition) const {
    auto made = make_summary_output({.enabled = true, .domain = test_domain(7), .partition = partition});
    EXPECT_TRUE(made) << made.error().text();
    return std::move(*made);
  }
  static void publish(SummaryOutput& to, const std::string& cell, std::uint64_t sequence) {
    CellSummary summary;
    summary.cell = cell;
    summary.sequence = sequence;
    to.publish(summary, cell_summary_text(summary));
  }
  [[nodiscard]] std::unique_ptr<SummaryReader> reader() {
    auto made = SummaryReader::open({.domain = test_domain(7)}, clock_, inbox_);
    EXPECT_TRUE(made) << made.error().text();
    return std::move(*made);
  }

  SystemClock clock_;
  Inbox inbox_;
};

TEST_F(DdsSummaryTest, AllCellsAreSeenWhateverTheirPartitions) {
  const auto left = output("left");
  const auto right = output("right");
  const auto sut = reader();
  ASSERT_TRUE(eventually([&] { return sut->writers() == 2; }));
  publish(*left, "left", 1);
  publish(*right, "right", 1);
  ASSERT_TRUE(eventually([&] { return inbox_.received().size() == 2; }));
  std::vector<std::string> cells;
  for (const ReceivedSummary& one : inbox_.received()) cells.push_back(one.summary.cell);
  std::ranges::sort(cells);
  EXPECT_EQ(cells, (std::vector<std::string>{"left", "right"}));
  EXPECT_NE(inbox_.received()[0].sender, inbox_.received()[1].sender);
}

TEST_F(DdsSummaryTest, WhoComesLaterHasTheNewestAtOnce) {
  const auto sut = output("");
  publish(*sut, "early", 7);
  const auto late = reader();
  ASSERT_TRUE(eventually([&] { return !inbox_.received().empty(); }));
  EXPECT_EQ(inbox_.received().back().summary.sequence, 7U);
}

TEST_F(DdsSummaryTest, AWriterThatIsClosedIsGone) {
  auto sut = output("");
  const auto from = reader();
  ASSERT_TRUE(eventually([&] { return from->writers() == 1; }));
  publish(*sut, "brief", 1);
  ASSERT_TRUE(eventually([&] { return inbox_.received().size() == 1; }));
  sut.reset();
  ASSERT_TRUE(eventually([&] { return inbox_.gone().size() == 1; }));
  EXPECT_EQ(inbox_.gone()[0], inbox_.received()[0].sender);
}

TEST_F(DdsSummaryTest, WhatIsNoSummaryIsRejectedWithTheReason) {
  const auto sut = output("");
  const auto from = reader();
  ASSERT_TRUE(eventually([&] { return from->writers() == 1; }));
  sut->publish({}, "hello");
  ASSERT_TRUE(eventually([&] { return inbox_.rejected().size() == 1; }));
  EXPECT_NE(inbox_.rejected()[0].find("not a JSON object"), std::string::npos);
  EXPECT_TRUE(inbox_.received().empty());
}

TEST_F(DdsSummaryTest, CycloneDdsReadsItAsAString) {
  const auto sut = output("left");
  publish(*sut, "judged", 3);
  CyclonePeer peer(test_domain(7));
  const dds_entity_t texts = peer.description_reader("rt/cellmirror/summary");
  std::vector<std::string> seen;
  ASSERT_TRUE(eventually([&] {
    for (auto& text : CyclonePeer::take_texts(texts)) seen.push_back(std::move(text));
    return !seen.empty();
  }));
  const auto read = parse_cell_summary(seen[0]);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->cell, "judged");
}

}  // namespace
}  // namespace cellmirror::dds::test
