#include "ipc/record/recover.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "ipc/record/encode.hpp"
#include "ipc/record/reader.hpp"
#include "ipc/record/summary.hpp"
#include "tests/unit/record/record_parts.hpp"

namespace cellmirror::mcap {
namespace {

using test::Collector;
using test::scanned;
using test::small_recording;

TEST(Recover, AWholeFileKeepsEverything) {
  const Bytes file = small_recording(Compression::lz4);
  MemorySink out;
  const auto report = recover(MemorySource(file), out, Compression::zstd);
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_TRUE(report->was_whole);
  Collector before;
  Collector after;
  scanned(file, before);
  const ScanReport copied = scanned(out.bytes, after);
  EXPECT_EQ(after.messages, before.messages);
  EXPECT_EQ(after.attachments, before.attachments);
  EXPECT_EQ(after.metadata, before.metadata);
  EXPECT_EQ(copied.header.profile, "ros2");
  EXPECT_EQ(copied.faults.count(), 0U);
}

TEST(Recover, ACutFileGetsASummary) {
  const Bytes file = small_recording(Compression::zstd);
  for (std::size_t size = file.size() - 1; size > 200; size -= 37) {
    MemorySink out;
    const auto report = recover(MemorySource(View(file).first(size)), out, Compression::zstd);
    ASSERT_TRUE(report) << report.error().text();
    EXPECT_FALSE(report->was_whole);
    const MemorySource source(out.bytes);
    const auto reader = Reader::open(source);
    ASSERT_TRUE(reader);
    ASSERT_TRUE(reader->indexed()) << reader->why_not_indexed();
    Collector left;
    scanned(View(file).first(size), left);
    EXPECT_EQ(reader->statistics().messages, left.messages.size());
  }
}

TEST(Recover, AChannelWhoseSchemaComesTooLateIsCopiedWithoutIt) {
  Bytes file;
  append_magic(file);
  append(Header{"", ""}, file);
  append(Channel{1, 5, "/a", "json"}, file);
  append(Message{1, 0, 0, 0, view_of("x")}, file);
  append(Schema{5, "s", "jsonschema", "{}"}, file);
  append(Channel{1, 5, "/a", "json"}, file);
  append(Message{1, 1, 1, 1, view_of("y")}, file);
  MemorySink out;
  const auto report = recover(MemorySource(file), out, Compression::none);
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_EQ(report->written.messages, 2U);
  Collector after;
  EXPECT_EQ(scanned(out.bytes, after).faults.count(), 0U);
}

// `topic` is described by a schema and a channel of the id 1.
Bytes recording_of(std::string_view topic, std::string_view content, bool with_end = true) {
  MemorySink out;
  Writer writer(out, {.profile = "", .library = "test", .compression = Compression::zstd, .chunk_bytes = 1000});
  EXPECT_TRUE(writer.begin());
  EXPECT_TRUE(writer.put(Schema{1, std::string(topic), "jsonschema", "{}"}));
  EXPECT_TRUE(writer.put(Channel{1, 1, std::string(topic), "json"}));
  EXPECT_TRUE(writer.put(Message{1, 0, 1, 1, view_of(content)}));
  EXPECT_TRUE(with_end ? writer.finish() : writer.flush());
  return out.bytes;
}

std::vector<std::string> recovered_messages(View file) {
  MemorySink out;
  const auto report = recover(MemorySource(file), out, Compression::none);
  EXPECT_TRUE(report) << report.error().text();
  Collector after;
  EXPECT_EQ(scanned(out.bytes, after).faults.count(), 0U);
  return after.messages;
}

Bytes joined(Bytes first, View second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

TEST(Recover, KeepsTheMessagesOfAllJoinedRecordings) {
  const Bytes file = joined(recording_of("/a", "x"), recording_of("/b", "y"));
  MemorySink out;
  const auto report = recover(MemorySource(file), out, Compression::none);
  ASSERT_TRUE(report);
  EXPECT_FALSE(report->was_whole);
  EXPECT_EQ(recovered_messages(file), (std::vector<std::string>{"/a 0 x", "/b 0 y"}));
  EXPECT_EQ(recovered_messages(joined(file, file)).size(), 4U);
}

TEST(Recover, KeepsARecordingThatIsJoinedToOneThatWasCutOff) {
  const Bytes second = recording_of("/b", "y");
  EXPECT_EQ(recovered_messages(joined(recording_of("/a", "x", false), second)),
            (std::vector<std::string>{"/a 0 x", "/b 0 y"}));
  Bytes first = recording_of("/a", "x", false);
  for (std::size_t left = first.size() - 1; left > kMagic.size(); --left) {
    first.resize(left);
    const auto messages = recovered_messages(joined(first, second));
    ASSERT_FALSE(messages.empty()) << left;
    EXPECT_EQ(messages.back(), "/b 0 y") << left;
  }
}

TEST(Recover, GoesOnBehindAHoleInAnAttachment) {
  const std::string large(4000, 'a');
  MemorySink out;
  Writer writer(out, {.profile = "", .library = "test", .compression = Compression::zstd, .chunk_bytes = 1000});
  ASSERT_TRUE(writer.begin());
  const std::size_t at = out.bytes.size();
  ASSERT_TRUE(writer.put(Attachment{5, 6, "cell.toml", "application/toml", view_of(large)}));
  ASSERT_TRUE(writer.put(Schema{1, "one", "jsonschema", "{}"}));
  ASSERT_TRUE(writer.put(Channel{1, 1, "/a", "json"}));
  ASSERT_TRUE(writer.put(Message{1, 0, 1, 1, view_of("x")}));
  ASSERT_TRUE(writer.flush());
  const Bytes cut_off = out.bytes;
  ASSERT_TRUE(writer.finish());
  for (const Bytes& whole : {cut_off, out.bytes}) {
    for (const int value : {0x00, 0x01, 0xff}) {
      for (std::size_t hole = at; hole < at + large.size(); hole += 3) {
        Bytes file = whole;
        std::fill_n(file.begin() + static_cast<std::ptrdiff_t>(hole), 64, static_cast<std::byte>(value));
        ASSERT_EQ(recovered_messages(file), std::vector<std::string>{"/a 0 x"}) << hole << " " << value;
      }
    }
  }
}

TEST(Recover, TakesLostChannelsFromTheSummary) {
  Bytes file = recording_of("/a", "x");
  const auto schema = std::ranges::search(file, view_of("jsonschema"));
  // The schema and the channel behind it, up to the topic.
  std::fill(schema.begin() - 16, schema.end() + 30, std::byte{0});
  EXPECT_EQ(recovered_messages(file), std::vector<std::string>{"/a 0 x"});
}

TEST(Reader, TakesASummaryWithoutSchemasForWholeButDoesNotUseIt) {
  Bytes file;
  append_magic(file);
  append(Header{"", ""}, file);
  append(Schema{5, "s", "jsonschema", "{}"}, file);
  append(Channel{1, 5, "/a", "json"}, file);
  append(Message{1, 0, 0, 0, view_of("x")}, file);
  append_data_end(0, file);
  Footer footer{.summary_start = file.size()};
  append(Channel{1, 5, "/a", "json"}, file);
  append(footer, file);
  append_magic(file);
  const MemorySource source(file);
  EXPECT_TRUE(read_summary(source, {}));
  const auto reader = Reader::open(source);
  ASSERT_TRUE(reader);
  EXPECT_NE(reader->catalogue().schema_of(reader->catalogue().channels.at(1)), nullptr);
}

TEST(Recover, WhatIsNoRecordingIsRefused) {
  MemorySink out;
  EXPECT_FALSE(recover(MemorySource(view_of("nothing of the kind")), out, Compression::zstd));
}

}  // namespace
}  // namespace cellmirror::mcap
