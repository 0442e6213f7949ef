#include "app/recording/recording_export.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "app/recording/flattener.hpp"
#include "app/recording/recording_report.hpp"
#include "app/recording/ros2_schema.hpp"
#include "drivers/can/channel/candump_line.hpp"
#include "drivers/dds/ros2_messages.hpp"
#include "rt_core/base/json_writer.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace {

constexpr std::string_view kCanTopics = "/inputs/can/";
constexpr std::string_view kJointState = "sensor_msgs/msg/JointState";

void put_text(std::FILE* out, std::string_view text) { std::fwrite(text.data(), 1, text.size(), out); }

// Quoted where a table program needs it.
std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\n\r") == std::string_view::npos) return std::string(text);
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

void note(ExportTotals& totals, const Error& error) {
  ++totals.left_out;
  if (totals.first_problem.empty()) totals.first_problem = error.text();
}

// Column of each path, in the order of their first appearance.
class Columns {
 public:
  bool add(const FlatMessage& message) {
    for (const FlatValue& value : message) {
      if (index_.contains(value.path)) continue;
      if (names_.size() >= kMostColumns) return false;
      index_.emplace(value.path, names_.size());
      names_.push_back(value.path);
    }
    return true;
  }
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] std::size_t of(const std::string& path) const { return index_.find(path)->second; }

 private:
  std::map<std::string, std::size_t, std::less<>> index_;
  std::vector<std::string> names_;
};

}  // namespace

Result<ExportTotals> export_csv(mcap::Reader& reader, const std::string& topic, mcap::Filter filter, std::FILE* out) {
  if (auto there = topic_is_there(reader, topic); !there) return std::unexpected(there.error());
  filter.topics = {topic};
  Flattener flattener(reader.catalogue());
  Columns columns;
  bool too_many = false;
  const auto look = [&](const mcap::Message& message, const mcap::Channel& channel) {
    const auto values = flattener.flatten(message, channel);
    too_many = values && !columns.add(*values);
    return !too_many;
  };
  if (auto read = reader.read(filter, look); !read) return std::unexpected(read.error());
  if (too_many)
    return fail(fmt::format("the messages of {} have more than {} different values", printable(topic), kMostColumns),
                "export them with --json, or a shorter time with --from and --to");
  std::string line = "log_time_ns,publish_time_ns";
  for (const std::string& name : columns.names()) line += "," + csv_field(name);
  put_text(out, line + "\n");
  ExportTotals totals;
  totals.columns = columns.names().size();
  std::vector<std::string> row(totals.columns);
  const auto write = [&](const mcap::Message& message, const mcap::Channel& channel) {
    const auto values = flattener.flatten(message, channel);
    if (!values) {
      note(totals, values.error());
      return true;
    }
    std::ranges::fill(row, std::string());
    for (const FlatValue& value : *values) row[columns.of(value.path)] = value.text;
    line = fmt::format("{},{}", message.log_time, message.publish_time);
    for (const std::string& field : row) (line += ',') += csv_field(field);
    put_text(out, line + "\n");
    ++totals.messages;
    return true;
  };
  if (auto read = reader.read(filter, write); !read) return std::unexpected(read.error());
  return totals;
}

Result<ExportTotals> export_json(mcap::Reader& reader, const std::string& topic, mcap::Filter filter, std::FILE* out) {
  if (auto there = topic_is_there(reader, topic); !there) return std::unexpected(there.error());
  filter.topics = {topic};
  Flattener flattener(reader.catalogue());
  ExportTotals totals;
  JsonWriter document(JsonWriter::kExact);
  document.begin_object().member("topic", topic).key("messages").begin_array();
  const auto write = [&](const mcap::Message& message, const mcap::Channel& channel) {
    const auto values = flattener.flatten(message, channel);
    if (!values) {
      note(totals, values.error());
      return true;
    }
    document.line().begin_object().member("log_time_ns", message.log_time);
    document.member("publish_time_ns", message.publish_time).key("values").begin_object();
    for (const FlatValue& value : *values) {
      const auto number = value.is_text ? std::nullopt : parse_number(value.text);
      if (value.is_text) {
        document.member(value.path, std::string_view(value.text));
      } else if (value.text == "true" || value.text == "false") {
        document.member(value.path, value.text == "true");
      } else {
        document.member(value.path, number);
      }
    }
    document.end_object().end_object();
    put_text(out, document.take());
    ++totals.messages;
    return true;
  };
  if (auto read = reader.read(filter, write); !read) return std::unexpected(read.error());
  document.line().end_array().end_object();
  put_text(out, document.take() + "\n");
  return totals;
}

Result<ExportTotals> export_candump(mcap::Reader& reader, const std::string& topic, mcap::Filter filter,
                                    std::FILE* out) {
  if (!topic.empty()) {
    if (auto there = topic_is_there(reader, topic); !there) return std::unexpected(there.error());
    filter.topics = {topic};
  }
  ExportTotals totals;
  totals.columns = 1;
  const auto write = [&](const mcap::Message& message, const mcap::Channel& channel) {
    if (!channel.topic.starts_with(kCanTopics) || channel.encoding != "json") return true;
    const auto values = flatten_json({reinterpret_cast<const char*>(message.data.data()), message.data.size()});
    const auto text = [&](std::string_view path) {
      const auto found = std::ranges::find(*values, path, &FlatValue::path);
      return found == values->end() ? std::string() : found->text;
    };
    const auto time_ns = values ? parse_integer(text("time_ns")) : std::nullopt;
    const std::string frame = values ? text("frame") : std::string();
    const std::string line =
        fmt::format("({:010}.{:06}) {} {}", time_ns.value_or(0) / 1'000'000'000,
                    time_ns.value_or(0) % 1'000'000'000 / 1000, channel.topic.substr(kCanTopics.size()), frame);
    if (!time_ns || *time_ns < 0 || !can::parse_candump_line(line)) {
      note(totals, {"a message that is no CAN frame", {}});
    } else if (text("sent") != "true") {
      put_text(out, line + "\n");
      ++totals.messages;
    }
    return true;
  };
  if (auto read = reader.read(filter, write); !read) return std::unexpected(read.error());
  if (totals.messages == 0 && totals.left_out == 0) return fail("the recording has no CAN frames");
  return totals;
}

namespace {

// The postures of a recording: robot.joint by name, as they become known.
class PostureRows {
 public:
  explicit PostureRows(const mcap::Catalogue& catalogue) : catalogue_(catalogue) {}

  // False: not a message of joints, or one that cannot be read; problem() says why.
  bool take(const mcap::Message& message, const mcap::Channel& channel) {
    const mcap::Schema* schema = catalogue_.schema_of(channel);
    if (schema == nullptr || schema->name != kJointState || channel.encoding != "cdr") return refuse({});
    if (decode(message.data, state_) != dds::CdrFault::none) return refuse("a message of joints is cut off");
    for (std::size_t i = 0; i < state_.name.size() && i < state_.position.size(); ++i) {
      const auto name = column_name(channel, state_.name[i]);
      if (!name) return refuse(fmt::format("the robot of the joint {} is not known", printable(state_.name[i])));
      if (!std::isfinite(state_.position[i])) return refuse("a position is no number");
      values_[*name] = state_.position[i];
    }
    return true;
  }
  [[nodiscard]] const std::string& problem() const { return problem_; }
  [[nodiscard]] const std::map<std::string, double, std::less<>>& values() const { return values_; }
  void forget() { values_.clear(); }

 private:
  bool refuse(std::string why) {
    problem_ = std::move(why);
    return false;
  }
  static std::optional<std::string> column_name(const mcap::Channel& channel, const std::string& joint) {
    const auto named = channel.metadata.find(std::string(kJointKey) + joint);
    if (named != channel.metadata.end()) return named->second;
    if (joint.find('.') != std::string::npos) return joint;
    const std::size_t slash = joint.find('/');
    if (slash == std::string::npos) return std::nullopt;
    return joint.substr(0, slash) + "." + joint.substr(slash + 1);
  }

  const mcap::Catalogue& catalogue_;
  dds::JointState state_;
  std::map<std::string, double, std::less<>> values_;
  std::string problem_;
};

}  // namespace

Result<ExportTotals> export_postures(mcap::Reader& reader, const std::string& topic, mcap::Filter filter,
                                     std::FILE* out) {
  if (!topic.empty()) {
    if (auto there = topic_is_there(reader, topic); !there) return std::unexpected(there.error());
    filter.topics = {topic};
  }
  PostureRows rows(reader.catalogue());
  const auto look = [&](const mcap::Message& message, const mcap::Channel& channel) {
    rows.take(message, channel);
    return true;
  };
  if (auto read = reader.read(filter, look); !read) return std::unexpected(read.error());
  ExportTotals totals;
  totals.columns = rows.values().size();
  if (totals.columns == 0)
    return fail(
        "the recording has no positions of joints" + (rows.problem().empty() ? std::string() : ": " + rows.problem()),
        "list its topics with: cellmirror recording info");
  std::string line;
  for (const auto& [name, value] : rows.values()) line += (line.empty() ? "" : ",") + csv_field(name);
  put_text(out, line + "\n");
  rows.forget();
  const auto write = [&](const mcap::Message& message, const mcap::Channel& channel) {
    if (!rows.take(message, channel)) {
      if (!rows.problem().empty()) note(totals, {rows.problem(), {}});
      return true;
    }
    if (rows.values().size() < totals.columns) {
      note(totals, {"not all joints had a position yet", {}});
      return true;
    }
    line.clear();
    for (const auto& [name, value] : rows.values()) line += fmt::format("{}{}", line.empty() ? "" : ",", value);
    put_text(out, line + "\n");
    ++totals.messages;
    return true;
  };
  if (auto read = reader.read(filter, write); !read) return std::unexpected(read.error());
  return totals;
}

}  // namespace cellmirror::app
