#include "ipc/record/writer.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "ipc/record/decode.hpp"
#include "ipc/record/reader.hpp"
#include "tests/unit/record/record_parts.hpp"

namespace cellmirror::mcap {
namespace {

using test::Collector;
using test::content_of;
using test::small_recording;

class RecordWriter : public testing::TestWithParam<Compression> {};

TEST_P(RecordWriter, WhatIsWrittenIsReadWithoutTheSummary) {
  const Bytes file = small_recording(GetParam());
  Collector found;
  const ScanReport report = test::scanned(file, found);
  EXPECT_EQ(report.faults.count(), 0U);
  EXPECT_TRUE(report.ended);
  EXPECT_EQ(report.header.profile, "ros2");
  ASSERT_EQ(found.messages.size(), 100U);
  EXPECT_EQ(found.messages[0], "/a 0 " + content_of(0));
  EXPECT_EQ(found.messages[99], "/b 99 " + content_of(99));
  EXPECT_EQ(found.attachments, std::vector<std::string>{"cell.toml name = 1"});
  EXPECT_EQ(found.metadata, std::vector<std::string>{"drops"});
  EXPECT_GE(report.chunks.size(), 5U);
}

TEST_P(RecordWriter, TheSummaryTellsWhatAScanFinds) {
  const Bytes file = small_recording(GetParam());
  Collector found;
  const ScanReport report = test::scanned(file, found);
  const auto summary = read_summary(MemorySource(file), {});
  ASSERT_TRUE(summary) << summary.error().text();
  EXPECT_EQ(*summary->statistics, report.statistics);
  EXPECT_EQ(summary->statistics->start_time, 1000U);
  EXPECT_EQ(summary->statistics->end_time, 1099U);
  ASSERT_EQ(summary->chunks.size(), report.chunks.size());
  for (std::size_t i = 0; i < report.chunks.size(); ++i) {
    EXPECT_EQ(summary->chunks[i].offset, report.chunks[i].offset);
    EXPECT_EQ(summary->chunks[i].length, report.chunks[i].length);
    EXPECT_EQ(summary->chunks[i].start_time, report.chunks[i].start_time);
    EXPECT_EQ(summary->chunks[i].compressed_size, report.chunks[i].compressed_size);
    EXPECT_EQ(summary->chunks[i].uncompressed_size, report.chunks[i].uncompressed_size);
  }
}

TEST_P(RecordWriter, MessageIndexesLieBehindTheirChunksAndPointAtMessages) {
  const Bytes file = small_recording(GetParam());
  const auto summary = read_summary(MemorySource(file), {});
  ASSERT_TRUE(summary);
  for (const ChunkIndex& chunk : summary->chunks) {
    RecordList at_chunk(View(file).subspan(chunk.offset, chunk.length));
    const auto record = at_chunk.next();
    ASSERT_TRUE(record && record->is(Opcode::chunk));
    ChunkOpener opener({}, file.size());
    const auto opened = opener.open(*decode_chunk(record->content));
    ASSERT_TRUE(opened);
    std::uint64_t length = 0;
    for (const auto& [channel, offset] : chunk.message_index_offsets) {
      EXPECT_EQ(offset, chunk.offset + chunk.length + length);
      RecordList at_index(View(file).subspan(offset));
      const auto index_record = at_index.next();
      ASSERT_TRUE(index_record && index_record->is(Opcode::message_index));
      length += kRecordHead + index_record->content.size();
      const auto index = decode_message_index(index_record->content);
      ASSERT_TRUE(index);
      EXPECT_EQ(index->channel, channel);
      for (const auto& [time, at] : index->entries) {
        RecordList messages(opened->subspan(at));
        const auto message = decode_message(messages.next()->content);
        EXPECT_EQ(message->log_time, time);
        EXPECT_EQ(message->channel, channel);
      }
    }
    EXPECT_EQ(length, chunk.message_index_length);
  }
}

TEST_P(RecordWriter, AReaderFindsTopicsAndTimesByTheIndex) {
  const Bytes file = small_recording(GetParam());
  const MemorySource source(file);
  auto reader = Reader::open(source);
  ASSERT_TRUE(reader);
  EXPECT_TRUE(reader->indexed()) << reader->why_not_indexed();
  std::vector<std::uint32_t> sequences;
  ASSERT_TRUE(reader->read({.topics = {"/b"}, .from = 1010, .to = 1015}, [&](const Message& message, const Channel&) {
    sequences.push_back(message.sequence);
    return true;
  }));
  EXPECT_EQ(sequences, (std::vector<std::uint32_t>{11, 13, 15}));
  EXPECT_EQ(reader->attachment("cell.toml"), "name = 1");
  EXPECT_EQ(reader->metadata("drops")->values.at("/a"), "3");
  EXPECT_FALSE(reader->attachment("other"));
}

INSTANTIATE_TEST_SUITE_P(Compressions, RecordWriter,
                         testing::Values(Compression::none, Compression::lz4, Compression::zstd));

// Refuses everything while `full`.
class FullSink final : public Sink {
 public:
  Result<void> write(std::span<const View> pieces) override {
    if (full) return fail("no room");
    return memory.write(pieces);
  }
  MemorySink memory;
  bool full = false;
};

TEST(RecordWriterOnAFullDisk, CountsWhatIsLostAndGoesOnWhenThereIsRoom) {
  FullSink sink;
  Writer writer(sink, {.compression = Compression::none, .chunk_bytes = 100});
  ASSERT_TRUE(writer.begin());
  ASSERT_TRUE(writer.put(Channel{7, 0, "/a", "json"}));
  const std::string content(60, 'y');
  ASSERT_TRUE(writer.put(Message{7, 1, 1, 1, view_of(content)}));
  sink.full = true;
  EXPECT_FALSE(writer.put(Message{7, 2, 2, 2, view_of(content)}));  // writes the first
  sink.full = false;
  EXPECT_TRUE(writer.put(Message{7, 3, 3, 3, view_of(content)}));
  EXPECT_TRUE(writer.finish());
  EXPECT_EQ(writer.lost().at(7), 1U);
  EXPECT_EQ(writer.statistics().channel_messages.at(7), 2U);
  Collector found;
  const ScanReport report = test::scanned(sink.memory.bytes, found);
  EXPECT_EQ(report.faults.count(), 0U);
  EXPECT_EQ(report.statistics, writer.statistics());
  ASSERT_EQ(found.messages.size(), 2U);
  EXPECT_TRUE(found.messages[0].starts_with("/a 2 "));
}

TEST(RecordWriterWithoutEnd, IsReadUpToTheLastChunk) {
  MemorySink sink;
  Writer writer(sink, {.chunk_bytes = 1000});
  ASSERT_TRUE(writer.begin());
  ASSERT_TRUE(writer.put(Channel{1, 0, "/a", "json"}));
  for (std::uint32_t i = 0; i < 50; ++i) ASSERT_TRUE(writer.put(Message{1, i, i, i, view_of(content_of(i))}));
  const std::uint64_t written = writer.statistics().messages;
  ASSERT_GT(written, 30U);
  Collector found;
  const ScanReport report = test::scanned(sink.bytes, found);
  EXPECT_EQ(found.messages.size(), written);
  EXPECT_FALSE(report.ended);
  EXPECT_EQ(report.whole_until, sink.bytes.size());
}

}  // namespace
}  // namespace cellmirror::mcap
