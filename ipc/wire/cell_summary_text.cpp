#include "ipc/wire/cell_summary_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <ranges>
#include <utility>

#include "rt_core/base/json_writer.hpp"
#include "rt_core/base/text.hpp"
#include "rt_core/base/utf8.hpp"
#include "rt_core/ports/words.hpp"

namespace cellmirror {
namespace {

using nlohmann::json;

constexpr const char* kVersionMember = "cellmirror_summary";
constexpr int kDigits = 6;
constexpr int kDeepest = 8;  // objects and arrays in each other

std::string_view cut(std::string_view text) { return cut_utf8(text, kMostSummaryText); }

void put_pair(JsonWriter& out, const BodyPair& pair) {
  out.begin_array().value(cut(pair.a)).value(cut(pair.b)).end_array();
}

void put_robot(JsonWriter& out, const RobotSummary& robot) {
  out.begin_object().member("id", cut(robot.id)).member("mode", robot_mode_word(robot.mirrored));
  if (robot.mirrored) out.member("state", word(robot.state));
  if (robot.age_s) out.fixed_member("age_s", *robot.age_s, 3);
  out.end_object();
}

void put_findings(JsonWriter& out, const CellSummary& summary) {
  out.key("nearest");
  if (summary.nearest) {
    out.begin_object().key("bodies");
    put_pair(out, summary.nearest->bodies);
    out.member("distance_m", summary.nearest->distance_m).end_object();
  } else {
    out.null();
  }
  out.member("touching", summary.touching).key("touching_pairs").begin_array();
  for (const BodyPair& pair : summary.touching_pairs | std::views::take(kMostSummaryPairs)) put_pair(out, pair);
  out.end_array();
}

std::string text_of(const CellSummary& summary, std::size_t most_robots) {
  JsonWriter out(kDigits);
  out.begin_object()
      .member(kVersionMember, summary.version)
      .member("cell", cut(summary.cell))
      .member("host", cut(summary.host))
      .member("instance", cut(summary.instance))
      .member("run", cut(summary.run))
      .member("sequence", summary.sequence)
      .member("time_ns", summary.time_ns)
      .fixed_member("uptime_s", summary.uptime_s, 1)
      .member("replay", summary.replay)
      .member("health", word(summary.health));
  out.key("reasons").begin_array();
  for (const std::string& reason : summary.reasons | std::views::take(kMostSummaryReasons)) out.value(cut(reason));
  out.end_array().key("loop").begin_object();
  out.member("rate_hz", summary.loop.rate_hz)
      .member("on_time", summary.loop.on_time)
      .member("missed", summary.loop.missed)
      .member("faults", summary.loop.faults)
      .end_object();
  out.key("robots").begin_array();
  const std::size_t sent = std::min(summary.robots.size(), most_robots);
  for (const RobotSummary& robot : summary.robots | std::views::take(sent)) put_robot(out, robot);
  out.end_array().member("robots_left_out", summary.robots_left_out + (summary.robots.size() - sent));
  put_findings(out, summary);
  out.key("alarms").begin_object().member("active", summary.alarms.active);
  out.member("unacknowledged", summary.alarms.unacknowledged).end_object();
  out.member("page_port", summary.page_port).end_object();
  return out.take();
}

// Members of one object, each of the kind that is asked for; another kind counts as absent.
class Members {
 public:
  explicit Members(const json& object) : object_(object) {}

  [[nodiscard]] const json* find(const char* name) const {
    const auto found = object_.find(name);
    return found == object_.end() ? nullptr : &*found;
  }
  [[nodiscard]] std::string text(const char* name) const { return cut_text(find(name)); }
  [[nodiscard]] bool truth(const char* name) const {
    const json* found = find(name);
    return found != nullptr && found->is_boolean() && found->get<bool>();
  }
  [[nodiscard]] std::optional<double> number(const char* name) const {
    const json* found = find(name);
    if (found == nullptr || !found->is_number()) return std::nullopt;
    const double value = found->get<double>();
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
  }
  template <class Integer>
  [[nodiscard]] Integer count(const char* name) const {
    const json* found = find(name);
    if (found == nullptr || !found->is_number_unsigned()) return 0;
    return static_cast<Integer>(
        std::min<std::uint64_t>(found->get<std::uint64_t>(), std::numeric_limits<Integer>::max()));
  }
  [[nodiscard]] const json& list(const char* name) const {
    static const json none = json::array();
    const json* found = find(name);
    return found != nullptr && found->is_array() ? *found : none;
  }
  [[nodiscard]] const json& object(const char* name) const {
    static const json none = json::object();
    const json* found = find(name);
    return found != nullptr && found->is_object() ? *found : none;
  }

  [[nodiscard]] static std::string cut_text(const json* value) {
    if (value == nullptr || !value->is_string()) return {};
    return std::string(cut(value->get_ref<const std::string&>()));
  }

 private:
  const json& object_;
};

template <class Enumeration, std::size_t kCount>
std::optional<Enumeration> find_word(const std::array<std::string_view, kCount>& words, std::string_view text) {
  const auto found = std::ranges::find(words, text);
  if (found == words.end()) return std::nullopt;
  return static_cast<Enumeration>(found - words.begin());
}

std::optional<BodyPair> pair_of(const json& value) {
  if (!value.is_array() || value.size() != 2) return std::nullopt;
  return BodyPair{Members::cut_text(&value[0]), Members::cut_text(&value[1])};
}

RobotSummary robot_of(const json& value) {
  const Members members(value);
  RobotSummary robot;
  robot.id = members.text("id");
  robot.mirrored = members.text("mode") == robot_mode_word(true);
  robot.state = find_word<DataState>(kDataStateWords, members.text("state")).value_or(DataState::none);
  robot.age_s = members.number("age_s");
  return robot;
}

void read_robots(const Members& members, CellSummary& out) {
  out.robots_left_out = members.count<std::size_t>("robots_left_out");
  for (const json& value : members.list("robots")) {
    if (!value.is_object()) continue;
    if (out.robots.size() < kMostSummaryRobots) {
      out.robots.push_back(robot_of(value));
    } else {
      ++out.robots_left_out;
    }
  }
}

void read_findings(const Members& members, CellSummary& out) {
  const Members nearest(members.object("nearest"));
  const json* bodies = nearest.find("bodies");
  const auto pair = bodies != nullptr ? pair_of(*bodies) : std::nullopt;
  const auto distance = nearest.number("distance_m");
  if (pair && distance) out.nearest = NearestPair{*pair, *distance};
  out.touching = members.count<std::size_t>("touching");
  for (const json& value : members.list("touching_pairs") | std::views::take(kMostSummaryPairs)) {
    if (const auto touching = pair_of(value)) out.touching_pairs.push_back(*touching);
  }
}

CellSummary summary_of(const json& document, int version) {
  const Members members(document);
  CellSummary out;
  out.version = version;
  out.cell = members.text("cell");
  out.host = members.text("host");
  out.instance = members.text("instance");
  out.run = members.text("run");
  out.sequence = members.count<std::uint64_t>("sequence");
  out.time_ns = members.count<std::int64_t>("time_ns");
  out.uptime_s = members.number("uptime_s").value_or(0);
  out.replay = members.truth("replay");
  // A word that is not known is of a newer version: nothing says that such a cell is well.
  out.health = find_word<CellHealth>(kCellHealthWords, members.text("health")).value_or(CellHealth::attention);
  for (const json& reason : members.list("reasons") | std::views::take(kMostSummaryReasons))
    out.reasons.push_back(Members::cut_text(&reason));
  const Members loop(members.object("loop"));
  out.loop = {loop.number("rate_hz").value_or(0), loop.count<std::uint64_t>("missed"),
              loop.count<std::uint64_t>("faults"), loop.truth("on_time")};
  read_robots(members, out);
  read_findings(members, out);
  const Members alarms(members.object("alarms"));
  out.alarms = {alarms.count<std::size_t>("active"), alarms.count<std::size_t>("unacknowledged")};
  out.page_port = members.count<std::uint16_t>("page_port");
  return out;
}

bool is_shallow(int depth, json::parse_event_t /*event*/, json& /*value*/) { return depth <= kDeepest; }

}  // namespace

std::string cell_summary_text(const CellSummary& summary) {
  std::size_t robots = kMostSummaryRobots;
  std::string text = text_of(summary, robots);
  // Only names of control characters, six bytes each in JSON, make it as long as that.
  while (text.size() > kMostSummaryBytes && robots > 0) text = text_of(summary, robots /= 2);
  return text;
}

Result<CellSummary> parse_cell_summary(std::string_view text) {
  if (text.size() > kMostSummaryBytes)
    return fail(fmt::format("a summary of {} bytes; the limit is {}", text.size(), kMostSummaryBytes));
  const json document = json::parse(text, is_shallow, /*allow_exceptions=*/false);
  if (!document.is_object()) return fail("not a JSON object: " + printable(text));
  const Members members(document);
  const int version = members.count<int>(kVersionMember);
  if (version < 1) return fail(fmt::format("no summary of a cell: \"{}\" is missing", kVersionMember));
  CellSummary out = summary_of(document, version);
  if (out.cell.empty()) return fail("a summary without the name of a cell");
  return out;
}

bool has_news(const CellSummary& last, const CellSummary& next) {
  const auto same_robot = [](const RobotSummary& a, const RobotSummary& b) {
    return a.id == b.id && a.mirrored == b.mirrored && a.state == b.state;
  };
  return last.health != next.health || last.loop.on_time != next.loop.on_time || last.touching != next.touching ||
         last.touching_pairs != next.touching_pairs || last.alarms != next.alarms || last.replay != next.replay ||
         last.page_port != next.page_port || last.reasons.size() != next.reasons.size() ||
         !std::ranges::equal(last.robots, next.robots, same_robot);
}

}  // namespace cellmirror
