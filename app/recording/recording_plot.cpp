#include "app/recording/recording_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "app/recording/flattener.hpp"
#include "app/recording_layout/recording_names.hpp"
#include "rt_core/base/counted.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace {

constexpr std::size_t kStretches = 1600;  // two for each pixel of a panel
constexpr std::size_t kMostNames = 50;    // of paths in a message

struct Point {
  double x = std::numeric_limits<double>::quiet_NaN();
  double y = 0;
};

// A line that keeps the first least and the first greatest value of each stretch.
class Series {
 public:
  void add(std::size_t stretch, double x, double y) {
    if (stretches_.empty()) stretches_.resize(kStretches);
    auto& [least, greatest] = stretches_[std::min(stretch, kStretches - 1)];
    if (std::isnan(least.x) || y < least.y) least = {x, y};
    if (std::isnan(greatest.x) || y > greatest.y) greatest = {x, y};
  }
  void append_to(plot::Line& line) const {
    const auto put = [&](const Point& point) {
      line.x.push_back(point.x);
      line.y.push_back(point.y);
    };
    for (const auto& [least, greatest] : stretches_) {
      if (std::isnan(least.x)) continue;
      const bool least_first = least.x <= greatest.x;
      put(least_first ? least : greatest);
      if (least.x != greatest.x) put(least_first ? greatest : least);
    }
  }

 private:
  std::vector<std::pair<Point, Point>> stretches_;
};

std::optional<double> number_in(const FlatValue& value) {
  if (value.is_text) return std::nullopt;
  if (value.text == "true") return 1.0;
  if (value.text == "false") return 0.0;
  const auto number = parse_number(value.text);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

bool is_of(std::string_view path, std::string_view field) {
  if (!path.starts_with(field)) return false;
  return path.size() == field.size() || path[field.size()] == '[' || path[field.size()] == '.';
}

// "[3]" of "position[3]"; empty: the path is no element.
std::string_view index_of(std::string_view path) {
  const std::size_t at = path.rfind('[');
  return path.ends_with(']') && at != std::string_view::npos ? path.substr(at) : std::string_view();
}

// The lines of a panel, in the order of their first appearance.
class SeriesList {
 public:
  Series& at(const std::string& path) {
    const auto [found, is_new] = index_.try_emplace(path, list_.size());
    if (is_new) list_.emplace_back(path, Series());
    return list_[found->second].second;
  }
  [[nodiscard]] const std::vector<std::pair<std::string, Series>>& list() const { return list_; }

 private:
  std::map<std::string, std::size_t, std::less<>> index_;
  std::vector<std::pair<std::string, Series>> list_;
};

// Collects the lines of all panels.
class Lines {
 public:
  // Times are seconds behind `zero_ns`; messages are from `start_ns` to `end_ns`.
  Lines(const std::vector<std::string>& fields, std::uint64_t zero_ns, std::uint64_t start_ns, std::uint64_t end_ns)
      : fields_(fields),
        start_s_(1e-9 * static_cast<double>(start_ns - zero_ns)),
        zero_ns_(zero_ns),
        length_s_(std::max(1e-9, 1e-9 * static_cast<double>(end_ns - start_ns))),
        panels_(fields.size()) {}

  // False: a panel has too many lines. `robots`: null where these are no joints; else metadata of the channel, which
  // may say whose they are.
  bool add(std::uint64_t time_ns, const FlatMessage& message, const mcap::Texts* robots) {
    const double x = 1e-9 * static_cast<double>(time_ns - std::min(time_ns, zero_ns_));
    const double part = std::clamp((x - start_s_) / length_s_, 0.0, 1.0);
    const auto stretch = static_cast<std::size_t>(part * static_cast<double>(kStretches));
    for (const FlatValue& value : message) {
      if (value.is_text && robots != nullptr && is_of(value.path, "name"))
        names_[std::string(index_of(value.path))] = value.text;
      const auto number = number_in(value);
      if (!number) continue;
      if (paths_.size() < kMostNames) paths_.insert(value.path);
      for (std::size_t i = 0; i < fields_.size(); ++i) {
        if (!is_of(value.path, fields_[i]) && (robots == nullptr || !is_joint_of(value.path, fields_[i], *robots)))
          continue;
        Series& series = panels_[i].at(value.path);
        if (panels_[i].list().size() > kMostLines) {
          crowded_ = fields_[i];
          return false;
        }
        series.add(stretch, x, *number);
      }
    }
    return true;
  }

  [[nodiscard]] Result<std::vector<plot::Panel>> panels(bool has_joints) const {
    if (!crowded_.empty()) {
      return fail(fmt::format("{} has more than {} values", printable(crowded_), kMostLines),
                  "name single ones, such as position[0], or those of a robot: position[ROBOT]");
    }
    std::vector<plot::Panel> out;
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      if (panels_[i].list().empty()) return nothing_of(fields_[i]);
      plot::Panel panel{
          .title = fields_[i], .x = {"time [s]"}, .y = {fields_[i]}, .histograms = {}, .lines = {}, .marks = {}};
      for (const auto& [path, series] : panels_[i].list()) {
        plot::Line line{.label = has_joints ? joint_of(path) : path, .x = {}, .y = {}};
        if (panels_[i].list().size() == 1) line.label.clear();
        series.append_to(line);
        panel.lines.push_back(std::move(line));
      }
      out.push_back(std::move(panel));
    }
    return out;
  }

 private:
  // "position[3]" of the field "position[turn]" or "position[ROBOT]", where it is that joint, or one of that robot.
  [[nodiscard]] bool is_joint_of(std::string_view path, std::string_view field, const mcap::Texts& robots) const {
    const std::string_view index = index_of(path);
    const std::string_view wanted = index_of(field);
    if (index.empty() || wanted.empty()) return false;
    if (path.substr(0, path.size() - index.size()) != field.substr(0, field.size() - wanted.size())) return false;
    const auto joint = names_.find(index);
    if (joint == names_.end()) return false;
    const std::string_view name = wanted.substr(1, wanted.size() - 2);
    if (joint->second == name) return true;
    const auto owner = robots.find(std::string(kJointKey) + joint->second);
    return owner != robots.end() && owner->second.starts_with(std::string(name) + ".");
  }
  [[nodiscard]] std::string joint_of(const std::string& path) const {
    const auto found = names_.find(index_of(path));
    return found == names_.end() ? path : found->second;
  }
  [[nodiscard]] std::unexpected<Error> nothing_of(const std::string& field) const {
    std::string names;
    for (const std::string& path : paths_) names += (names.empty() ? "" : ", ") + path;
    return fail(fmt::format("the messages have no number {}", printable(field)),
                names.empty() ? "there are no numbers in this time" : "there are: " + printable(names));
  }

  const std::vector<std::string>& fields_;
  double start_s_;
  std::uint64_t zero_ns_;
  double length_s_;
  std::vector<SeriesList> panels_;
  std::map<std::string, std::string, std::less<>> names_;  // of joints, by "[3]"
  std::set<std::string> paths_;
  std::string crowded_;
};

}  // namespace

Result<plot::Figure> recording_figure(mcap::Reader& reader, const std::string& topic,
                                      const std::vector<std::string>& fields, mcap::Filter filter) {
  if (fields.empty() || fields.size() > kMostPanels)
    return fail(fmt::format("{} fields were named", fields.size()), fmt::format("name 1 to {}", kMostPanels));
  if (auto there = topic_is_there(reader, topic); !there) return std::unexpected(there.error());
  filter.topics = {topic};
  const std::uint64_t zero = reader.statistics().start_time;
  const std::uint64_t start = std::max(filter.from, zero);
  const std::uint64_t end = std::max(start, std::min(filter.to, reader.statistics().end_time));
  Flattener flattener(reader.catalogue());
  Lines lines(fields, zero, start, end);
  std::uint64_t messages = 0;
  bool has_joints = false;
  Error first_problem;
  const auto take = [&](const mcap::Message& message, const mcap::Channel& channel) {
    const auto values = flattener.flatten(message, channel);
    if (!values) {
      if (first_problem.what.empty()) first_problem = values.error();
      return true;
    }
    const mcap::Schema* schema = reader.catalogue().schema_of(channel);
    has_joints = schema != nullptr && schema->name == "sensor_msgs/msg/JointState";
    ++messages;
    return lines.add(message.log_time, *values, has_joints ? &channel.metadata : nullptr);
  };
  if (auto read = reader.read(filter, take); !read) return std::unexpected(read.error());
  if (messages == 0 && !first_problem.what.empty()) return std::unexpected(first_problem);
  auto panels = lines.panels(has_joints);
  if (!panels) return std::unexpected(panels.error());
  plot::Figure figure;
  figure.title = topic;
  figure.subtitle =
      fmt::format("{}, {:.1f} s", number_of(messages, "message"), 1e-9 * static_cast<double>(end - start));
  figure.panels = *std::move(panels);
  figure.columns = figure.panels.size() > 3 ? 2 : 1;
  return figure;
}

}  // namespace cellmirror::app
