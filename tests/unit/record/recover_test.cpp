#include "ipc/record/recover.hpp"

#include <gtest/gtest.h>

#include "ipc/record/encode.hpp"
#include "ipc/record/reader.hpp"
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

TEST(Recover, WhatIsNoRecordingIsRefused) {
  MemorySink out;
  EXPECT_FALSE(recover(MemorySource(view_of("nothing of the kind")), out, Compression::zstd));
}

}  // namespace
}  // namespace cellmirror::mcap
