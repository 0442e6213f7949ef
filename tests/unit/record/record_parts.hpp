// What the tests of recordings share: a small recording in memory, and what a scan finds in bytes.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "ipc/record/scan.hpp"
#include "ipc/record/writer.hpp"

namespace cellmirror::mcap::test {

inline std::string text_of(View bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

class Collector final : public Visitor {
 public:
  void on_message(const Message& message, const Channel& channel) override {
    messages.push_back(channel.topic + " " + std::to_string(message.sequence) + " " + text_of(message.data));
  }
  void on_attachment(const Attachment& attachment, const RecordView& /*record*/) override {
    attachments.push_back(attachment.name + " " + text_of(attachment.data));
  }
  void on_metadata(const Metadata& one, const RecordView& /*record*/) override { metadata.push_back(one.name); }

  std::vector<std::string> messages;
  std::vector<std::string> attachments;
  std::vector<std::string> metadata;
};

inline ScanReport scanned(View bytes, Collector& into, const Limits& limits = {}) {
  auto report = scan(MemorySource(bytes), limits, into);
  EXPECT_TRUE(report) << report.error().text();
  return report ? *std::move(report) : ScanReport{};
}

inline std::string content_of(std::uint32_t i) { return "message " + std::to_string(i) + std::string(40, 'x'); }

// `messages` of 50-odd bytes on "/a" and "/b" by turns, in chunks of 1000 bytes.
inline Bytes small_recording(Compression compression, std::uint32_t messages = 100) {
  MemorySink out;
  Writer writer(out, {.profile = "ros2", .library = "test", .compression = compression, .chunk_bytes = 1000});
  EXPECT_TRUE(writer.begin());
  EXPECT_TRUE(writer.put(Schema{1, "one", "jsonschema", "{}"}));
  EXPECT_TRUE(writer.put(Channel{1, 1, "/a", "json", {{"key", "value"}}}));
  EXPECT_TRUE(writer.put(Channel{2, 0, "/b", "json"}));
  for (std::uint32_t i = 0; i < messages; ++i) {
    const std::string content = content_of(i);
    EXPECT_TRUE(writer.put(Message{static_cast<std::uint16_t>(1 + i % 2), i, 1000 + i, 900 + i, view_of(content)}));
  }
  EXPECT_TRUE(writer.put(Attachment{5, 6, "cell.toml", "application/toml", view_of("name = 1")}));
  EXPECT_TRUE(writer.put(Metadata{"drops", {{"/a", "3"}}}));
  EXPECT_TRUE(writer.finish());
  return out.bytes;
}

}  // namespace cellmirror::mcap::test
