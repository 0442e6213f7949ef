// Bytes that no writer of ours makes: cut off, flipped, lying. Nothing may crash, and what is whole is found.
#include <gtest/gtest.h>

#include <algorithm>

#include "ipc/record/encode.hpp"
#include "ipc/record/reader.hpp"
#include "ipc/record/record_stream.hpp"
#include "ipc/record/recover.hpp"
#include "tests/unit/record/record_parts.hpp"

namespace cellmirror::mcap {
namespace {

using test::Collector;
using test::scanned;
using test::small_recording;

Bytes begun() {
  Bytes out;
  append_magic(out);
  append(Header{"", ""}, out);
  append(Channel{1, 0, "/a", "json"}, out);
  return out;
}

std::string first_fault(const ScanReport& report) {
  return report.faults.first().empty() ? std::string() : report.faults.first().front().what;
}

TEST(HostileRecording, CutAtAnyByteGivesWhatIsWholeBefore) {
  const Bytes file = small_recording(Compression::zstd);
  Collector all;
  scanned(file, all);
  std::size_t before = 0;
  for (std::size_t size = kMagic.size(); size < file.size(); ++size) {
    Collector found;
    const ScanReport report = scanned(View(file).first(size), found);
    ASSERT_GE(found.messages.size(), before) << size;
    ASSERT_LE(report.whole_until, size);
    ASSERT_GT(report.faults.count(), 0U) << size;
    for (std::size_t i = before; i < found.messages.size(); ++i) ASSERT_EQ(found.messages[i], all.messages[i]);
    before = found.messages.size();
  }
  EXPECT_EQ(before, 100U);
}

// Counts what is read of it.
class CountingSource final : public Source {
 public:
  explicit CountingSource(View bytes) : bytes_(bytes) {}
  [[nodiscard]] std::uint64_t size() const override { return bytes_.size(); }
  Result<void> read(std::uint64_t offset, std::span<std::byte> into) const override {
    read_bytes += into.size();
    return bytes_.read(offset, into);
  }
  mutable std::uint64_t read_bytes = 0;

 private:
  MemorySource bytes_;
};

TEST(HostileRecording, WithoutASummaryItIsReadAsAWholeOnceAndThenByItsChunks) {
  const Bytes whole = small_recording(Compression::none);
  const auto report = [&] {
    Collector all;
    return scanned(whole, all);
  }();
  const std::uint64_t end = report.chunks.back().offset + report.chunks.back().length;
  const CountingSource source(View(whole).first(end));
  auto reader = Reader::open(source);
  ASSERT_TRUE(reader);
  EXPECT_FALSE(reader->indexed());
  source.read_bytes = 0;
  std::vector<std::uint64_t> times;
  const Filter late{.topics = {"/b"}, .from = report.chunks.back().start_time};
  ASSERT_TRUE(reader->read(late, [&](const Message& message, const Channel& channel) {
    EXPECT_EQ(channel.topic, "/b");
    times.push_back(message.log_time);
    return true;
  }));
  EXPECT_FALSE(times.empty());
  EXPECT_GE(times.front(), report.chunks.back().start_time);
  EXPECT_LE(source.read_bytes, report.chunks.back().length) << "only the chunk that has them";
}

TEST(HostileRecording, AFlippedBitInAChunkIsFoundByItsCrcAndTheOthersAreRead) {
  Bytes file = small_recording(Compression::none);
  const auto summary = read_summary(MemorySource(file), {});
  ASSERT_TRUE(summary);
  const ChunkIndex& second = summary->chunks.at(1);
  file[second.offset + second.length - 5] ^= std::byte{0x10};
  Collector found;
  const ScanReport report = scanned(file, found);
  EXPECT_EQ(report.faults.count(), 1U);
  EXPECT_EQ(report.faults.first().front().offset, second.offset);
  EXPECT_NE(first_fault(report).find("CRC"), std::string::npos);
  EXPECT_EQ(report.chunks_lost, 1U);
  EXPECT_GT(found.messages.size(), 80U);
}

TEST(HostileRecording, BehindALengthThatLiesTheSummaryShowsTheNextChunk) {
  Bytes file = small_recording(Compression::zstd);
  const auto summary = read_summary(MemorySource(file), {});
  ASSERT_TRUE(summary);
  file[summary->chunks.at(1).offset + 8] = std::byte{0x7F};  // the greatest byte of its length
  Collector found;
  const ScanReport report = scanned(file, found);
  EXPECT_EQ(report.faults.count(), 1U);
  EXPECT_EQ(report.faults.first().front().offset, summary->chunks[1].offset);
  EXPECT_EQ(report.chunks.size(), summary->chunks.size() - 1);
  EXPECT_TRUE(report.ended);
}

TEST(HostileRecording, AChunkThatBlowsUpIsRefused) {
  const Bytes zeros(std::size_t{8} << 20);
  for (const Compression compression : {Compression::zstd, Compression::lz4}) {
    Compressor compressor(compression);
    const auto small = compressor.compress(zeros);
    ASSERT_TRUE(small);
    ASSERT_LT(small->size(), zeros.size() / 100);
    // More than it says.
    Bytes file = begun();
    append(Chunk{0, 0, 1000, 0, std::string(word(compression)), *small}, file);
    Collector found;
    EXPECT_EQ(scanned(file, found).chunks_lost, 1U);
    // As much as it says, which is more than is accepted.
    file = begun();
    append(Chunk{0, 0, zeros.size(), 0, std::string(word(compression)), *small}, file);
    const ScanReport report = scanned(file, found, {.chunk_bytes = std::size_t{1} << 20});
    EXPECT_NE(first_fault(report).find("more than the 1048576 that are accepted"), std::string::npos)
        << first_fault(report);
    // Less than it says.
    file = begun();
    append(Chunk{0, 0, zeros.size() + 1, 0, std::string(word(compression)), *small}, file);
    EXPECT_EQ(scanned(file, found).chunks_lost, 1U);
    EXPECT_TRUE(found.messages.empty());
  }
}

// A small file with `chunks` chunks, each of which decompresses to `bytes` times `value`.
Bytes blown_up(int chunks, std::size_t bytes, std::byte value) {
  Compressor compressor(Compression::zstd);
  const Bytes content(bytes, value);
  const auto small = compressor.compress(content);
  EXPECT_TRUE(small);
  Bytes file = begun();
  for (int i = 0; i < chunks; ++i) append(Chunk{0, 0, bytes, 0, "zstd", *small}, file);
  append_data_end(0, file);
  append(Footer{}, file);
  append_magic(file);
  return file;
}

constexpr std::uint64_t kMega = 1'000'000;

TEST(HostileRecording, ChunksBeyondTheTotalLimitAreRefused) {
  const Bytes file = blown_up(5, 8 * kMega, std::byte{0});
  ASSERT_LT(file.size(), 10'000U);
  const MemorySource source(file);
  const Limits limits{.decompressed_bytes = 20 * kMega};
  Collector found;
  const auto refused = scan(source, limits, found);
  ASSERT_FALSE(refused);
  EXPECT_TRUE(refused.error().what.starts_with("at byte ")) << refused.error().what;
  EXPECT_NE(refused.error().what.find("more than 0.0 GB decompressed"), std::string::npos) << refused.error().what;
  EXPECT_NE(refused.error().remedy.find("--decompressed-limit"), std::string::npos) << refused.error().remedy;
  EXPECT_FALSE(Reader::open(source, limits));
  MemorySink out;
  EXPECT_FALSE(recover(source, out, Compression::none, limits));
  // A caller can raise the limit.
  EXPECT_EQ(scanned(file, found, {.decompressed_bytes = 40 * kMega}).chunks.size(), 5U);
  EXPECT_EQ(scanned(file, found, {.decompressed_bytes = 0, .decompressed_ratio = 100'000}).chunks.size(), 5U);
}

TEST(HostileRecording, ChunksBeyondTheLimitCanBeLeftOutAndAreCounted) {
  const Bytes file = blown_up(5, 8 * kMega, std::byte{0});
  const MemorySource source(file);
  const auto reader = Reader::open(source, {.decompressed_bytes = 20 * kMega, .leave_out_beyond = true});
  ASSERT_TRUE(reader) << reader.error().text();
  EXPECT_EQ(reader->chunks().size(), 5U);
  EXPECT_EQ(reader->chunks_left_out(), 3U);
  EXPECT_EQ(reader->statistics().chunks, 5U);
}

TEST(HostileRecording, AnIndexedFileHasTheSameLimit) {
  const Bytes file = small_recording(Compression::zstd);
  const MemorySource source(file);
  std::uint64_t bytes = 0;
  const auto count = [&](const Message& message, const Channel&) {
    bytes += message.data.size();
    return true;
  };
  auto reader = Reader::open(source, {.decompressed_bytes = 3000, .decompressed_ratio = 0});
  ASSERT_TRUE(reader && reader->indexed()) << "the index is read without any chunk";
  const auto read = reader->read({}, count);
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().remedy.find("--decompressed-limit"), std::string::npos) << read.error().text();
  EXPECT_LE(bytes, 3000U);
  // Uncompressed chunks do not count.
  const Bytes plain = small_recording(Compression::none);
  const MemorySource plain_source(plain);
  auto plain_reader = Reader::open(plain_source, {.decompressed_bytes = 0, .decompressed_ratio = 0});
  ASSERT_TRUE(plain_reader);
  EXPECT_TRUE(plain_reader->read({}, count));
}

TEST(HostileRecording, ARecordWithOpcodeZeroEndsItsChunk) {
  Collector found;
  const ScanReport report = scanned(blown_up(2, 8 * kMega, std::byte{0}), found);
  EXPECT_EQ(report.faults.count(), 2U) << "one for each chunk, not one for every nine bytes";
  EXPECT_NE(first_fault(report).find("no whole record at its byte 0"), std::string::npos) << first_fault(report);
}

TEST(HostileRecording, ManyFaultsAreCountedAndTheFirstAreKept) {
  Bytes records;
  constexpr int kMany = 100'000;
  for (int i = 0; i < kMany; ++i) {
    records.insert(records.end(), kRecordHead, std::byte{0});
    records[records.size() - kRecordHead] = std::byte{0x80};
  }
  Bytes file = begun();
  append(Chunk{0, 0, records.size(), 0, "", records}, file);
  Collector found;
  const ScanReport report = scanned(file, found);
  EXPECT_EQ(report.faults.count(), kMany + 1U);  // one more for the missing end
  EXPECT_EQ(report.faults.first().size(), Faults::kKept);
}

TEST(HostileRecording, ReportsTheProgressOfReading) {
  const Bytes file = small_recording(Compression::zstd);
  std::uint64_t last = 0;
  int calls = 0;
  const ReadProgress progress = [&](std::uint64_t done, std::uint64_t total) {
    EXPECT_GE(done, last);
    EXPECT_LE(done, total);
    last = done;
    ++calls;
  };
  Collector found;
  scanned(file, found, {.progress = &progress});
  EXPECT_GT(calls, 5);
  last = 0;
  calls = 0;
  const MemorySource source(file);
  auto reader = Reader::open(source, {.progress = &progress});
  ASSERT_TRUE(reader && reader->indexed());
  EXPECT_EQ(calls, 0);
  ASSERT_TRUE(reader->read({}, [](const Message&, const Channel&) { return true; }));
  EXPECT_GT(calls, 3);
}

TEST(HostileRecording, TheDecompressorWritesNoMoreThanItIsGiven) {
  const Bytes content(1000, std::byte{7});
  for (const Compression compression : {Compression::zstd, Compression::lz4}) {
    Compressor compressor(compression);
    const auto small = compressor.compress(content);
    ASSERT_TRUE(small);
    Decompressor decompressor;
    EXPECT_FALSE(decompressor.decompress(word(compression), *small, 999));
    EXPECT_FALSE(decompressor.decompress(word(compression), *small, 0));
    EXPECT_FALSE(decompressor.decompress(word(compression), *small, 1001));
    const auto whole = decompressor.decompress(word(compression), *small, 1000);
    ASSERT_TRUE(whole);
    EXPECT_TRUE(std::ranges::equal(*whole, content));
    EXPECT_FALSE(decompressor.decompress(word(compression), small->first(small->size() - 1), 1000));
  }
  EXPECT_FALSE(Decompressor().decompress("bz2", content, 1000));
}

TEST(HostileRecording, MessagesOfUnknownChannelsAreNotPassedOn) {
  Bytes file = begun();
  append(Message{2, 0, 0, 0, view_of("x")}, file);
  append(Message{1, 0, 0, 0, view_of("y")}, file);
  Collector found;
  const ScanReport report = scanned(file, found);
  EXPECT_EQ(found.messages, std::vector<std::string>{"/a 0 y"});
  EXPECT_NE(first_fault(report).find("channel 2"), std::string::npos);
}

TEST(HostileRecording, AChannelIsWhatItsFirstDescriptionSays) {
  Bytes file = begun();
  append(Channel{1, 0, "/b", "json"}, file);
  append(Channel{3, 9, "/c", "json"}, file);
  append(Schema{0, "n", "e", "d"}, file);
  append(Message{1, 0, 0, 0, view_of("y")}, file);
  Collector found;
  const ScanReport report = scanned(file, found);
  EXPECT_EQ(found.messages, std::vector<std::string>{"/a 0 y"});
  EXPECT_EQ(report.faults.count(), 4U);  // with the end that is not there
}

TEST(HostileRecording, ZerosAfterALostPowerEndTheReading) {
  Bytes file = small_recording(Compression::lz4);
  const auto summary = read_summary(MemorySource(file), {});
  ASSERT_TRUE(summary);
  file.resize(summary->chunks.at(2).offset);
  file.resize(file.size() + 4096);
  Collector found;
  const ScanReport report = scanned(file, found);
  EXPECT_EQ(report.chunks.size(), 2U);
  EXPECT_EQ(report.whole_until, file.size() - 4096);
}

TEST(HostileRecording, WhatIsNoMcapFileIsRefused) {
  Collector found;
  EXPECT_FALSE(scan(MemorySource({}), {}, found));
  EXPECT_FALSE(scan(MemorySource(view_of("#ROSBAG V2.0\n")), {}, found));
  EXPECT_FALSE(Reader::open(MemorySource(view_of("short"))));
}

TEST(HostileRecording, ASummaryWithWrongOffsetsIsNotUsed) {
  Bytes file = small_recording(Compression::zstd);
  file[file.size() - 20 - 8] ^= std::byte{1};  // in the footer: the start of the summary
  const MemorySource source(file);
  EXPECT_FALSE(read_summary(source, {}));
  auto reader = Reader::open(source);
  ASSERT_TRUE(reader);
  EXPECT_FALSE(reader->indexed());
  EXPECT_EQ(reader->statistics().messages, 100U);
  EXPECT_EQ(reader->attachment("cell.toml"), "name = 1");
}

TEST(HostileRecording, AnIndexThatPointsElsewhereIsAnErrorWithItsOffset) {
  const Bytes file = small_recording(Compression::zstd);
  // The same file, its footer's CRC left out, and a chunk's offset in the summary changed.
  Bytes changed = file;
  const auto summary = read_summary(MemorySource(file), {});
  ASSERT_TRUE(summary);
  for (std::size_t i = 0; i < 4; ++i) changed[changed.size() - 8 - 4 + i] = std::byte{0};
  Bytes index;
  append(summary->chunks.at(0), index);
  const auto at = std::ranges::search(changed, index);
  ASSERT_FALSE(at.empty());
  at[kRecordHead + 16] ^= std::byte{1};
  const MemorySource source(changed);
  auto reader = Reader::open(source);
  ASSERT_TRUE(reader && reader->indexed());
  const auto read = reader->read({}, [](const Message&, const Channel&) { return true; });
  ASSERT_FALSE(read);
  EXPECT_TRUE(read.error().what.starts_with("at byte ")) << read.error().what;
}

}  // namespace
}  // namespace cellmirror::mcap
