// Reads all MCAP files of a folder with our reader, and writes their contents with our writer into another folder. What
// was read is one JSON document on standard output: {name: {records, messages, indexed, statistics, faults}}. Used by
// record_conformance_test.py.
//   record_conformance FOLDER OUT COMPRESSION
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/record/compression.hpp"
#include "ipc/record/reader.hpp"
#include "ipc/record/recover.hpp"
#include "rt_core/base/json_writer.hpp"

namespace {

using namespace cellmirror;

void write_data(mcap::View data, JsonWriter& out) {
  out.key("data").begin_array();
  for (const std::byte one : data) out.value(std::to_integer<int>(one));
  out.end_array();
}

void write_texts(const mcap::Texts& texts, JsonWriter& out) {
  out.key("metadata").begin_object();
  for (const auto& [key, value] : texts) out.member(key, std::string_view(value));
  out.end_object();
}

void write_message(const mcap::Message& message, JsonWriter& out) {
  out.begin_object()
      .member("type", "Message")
      .member("channelId", message.channel)
      .member("sequence", message.sequence)
      .member("logTime", std::string_view(std::to_string(message.log_time)))
      .member("publishTime", std::string_view(std::to_string(message.publish_time)));
  write_data(message.data, out);
  out.end_object();
}

// The records of the data section, with the names that @mcap/core gives them.
class Records final : public mcap::Visitor {
 public:
  explicit Records(JsonWriter& out) : out_(out) {}
  void on_schema(const mcap::Schema& schema) override {
    out_.begin_object()
        .member("type", "Schema")
        .member("id", schema.id)
        .member("name", std::string_view(schema.name))
        .member("encoding", std::string_view(schema.encoding));
    write_data(mcap::view_of(schema.data), out_);
    out_.end_object();
  }
  void on_channel(const mcap::Channel& channel) override {
    out_.begin_object()
        .member("type", "Channel")
        .member("id", channel.id)
        .member("topic", std::string_view(channel.topic))
        .member("schemaId", channel.schema)
        .member("messageEncoding", std::string_view(channel.encoding));
    write_texts(channel.metadata, out_);
    out_.end_object();
  }
  void on_message(const mcap::Message& message, const mcap::Channel& /*channel*/) override {
    write_message(message, out_);
  }
  void on_attachment(const mcap::Attachment& attachment, const mcap::RecordView& /*record*/) override {
    out_.begin_object()
        .member("type", "Attachment")
        .member("name", std::string_view(attachment.name))
        .member("mediaType", std::string_view(attachment.media_type))
        .member("logTime", std::string_view(std::to_string(attachment.log_time)))
        .member("createTime", std::string_view(std::to_string(attachment.create_time)));
    write_data(attachment.data, out_);
    out_.end_object();
  }
  void on_metadata(const mcap::Metadata& metadata, const mcap::RecordView& /*record*/) override {
    out_.begin_object().member("type", "Metadata").member("name", std::string_view(metadata.name));
    write_texts(metadata.values, out_);
    out_.end_object();
  }

 private:
  JsonWriter& out_;
};

// As a reader of topics and times sees it.
Result<void> write_read(const mcap::Source& source, JsonWriter& out) {
  auto reader = mcap::Reader::open(source);
  if (!reader) return std::unexpected(reader.error());
  out.member("indexed", reader->indexed()).key("messages").begin_array();
  auto read = reader->read({}, [&](const mcap::Message& message, const mcap::Channel& /*channel*/) {
    write_message(message, out);
    return true;
  });
  out.end_array();
  const mcap::Statistics& of = reader->statistics();
  out.key("statistics")
      .begin_object()
      .member("messageCount", of.messages)
      .member("schemaCount", of.schemas)
      .member("channelCount", of.channels)
      .member("attachmentCount", of.attachments)
      .member("metadataCount", of.metadata)
      .member("chunkCount", of.chunks)
      .member("messageStartTime", of.start_time)
      .member("messageEndTime", of.end_time)
      .end_object();
  return read;
}

Result<void> look_at(const std::filesystem::path& file, const std::filesystem::path& copy,
                     mcap::Compression compression, JsonWriter& out) {
  const auto source = mcap::FileSource::open(file);
  if (!source) return std::unexpected(source.error());
  out.key(file.stem().string()).begin_object().key("records").begin_array();
  Records records(out);
  auto report = mcap::scan(**source, {}, records);
  if (!report) return std::unexpected(report.error());
  out.end_array().member("ended", report->ended).member("faults", report->faults.count());
  if (auto read = write_read(**source, out); !read) return read;
  out.end_object();
  auto sink = mcap::FileSink::create(copy);
  if (!sink) return std::unexpected(sink.error());
  const auto written = mcap::recover(**source, **sink, compression);
  if (!written) return std::unexpected(written.error());
  return {};
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) return 2;
  const std::filesystem::path folder = arguments[1];
  const std::filesystem::path copies = arguments[2];
  const auto compression = mcap::compression_of(arguments[3]);
  if (!compression) return 2;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
  std::ranges::sort(files);
  JsonWriter out;
  out.begin_object();
  for (const std::filesystem::path& file : files) {
    if (auto done = look_at(file, copies / file.filename(), *compression, out); !done) {
      std::cerr << file.string() << ": " << done.error().text() << "\n";
      return 1;
    }
  }
  out.end_object();
  std::cout << out.take() << "\n";
}
