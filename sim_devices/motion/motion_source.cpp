#include "sim_devices/motion/motion_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "rt_core/base/home.hpp"
#include "rt_core/base/text.hpp"
#include "sim_devices/motion/motion_table.hpp"

namespace cellmirror::sim {
namespace {

constexpr std::size_t kMostFileBytes = 64UL << 20U;

class Hold final : public MotionSource {
 public:
  explicit Hold(double position) : position_(position) {}
  void at(double, std::span<JointValue> values) const override {
    for (JointValue& value : values) value.position = position_, value.velocity = 0;
  }

 private:
  double position_;
};

class Ramp final : public MotionSource {
 public:
  Ramp(double velocity, double offset) : velocity_(velocity), offset_(offset) {}
  void at(double t_s, std::span<JointValue> values) const override {
    for (JointValue& value : values) value.position = offset_ + velocity_ * t_s, value.velocity = velocity_;
  }

 private:
  double velocity_;
  double offset_;
};

struct SineParameters {
  double amplitude, period_s, offset, phase, step;
};

class Sine final : public MotionSource {
 public:
  explicit Sine(SineParameters parameters) : p_(parameters) {}
  void at(double t_s, std::span<JointValue> values) const override {
    const double omega = 2 * std::numbers::pi / p_.period_s;
    double angle = omega * t_s + p_.phase;
    for (JointValue& value : values) {
      value.position = p_.offset + p_.amplitude * std::sin(angle);
      value.velocity = p_.amplitude * omega * std::cos(angle);
      angle += p_.step;
    }
  }

 private:
  SineParameters p_;
};

// Rest-to-rest polynomial of the fifth degree from 0 to 1 over s in [0, 1], with the least jerk (Flash, Hogan 1985).
double minimum_jerk(double s) { return s * s * s * (10 + s * (6 * s - 15)); }
double minimum_jerk_rate(double s) { return 30 * s * s * (1 + s * (s - 2)); }

class Table final : public MotionSource {
 public:
  Table(MotionTable table, bool stops, bool once) : table_(std::move(table)), stops_(stops), once_(once) {}

  void at(double t_s, std::span<JointValue> values) const override {
    const double length = table_.time_s.back();
    double t = std::max(t_s, 0.0);
    if (t > length) t = once_ || length <= 0 ? length : std::fmod(t, length);
    const auto next = std::upper_bound(table_.time_s.begin(), table_.time_s.end(), t);
    const auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(next - table_.time_s.begin() - 1, 0));
    if (i + 1 >= table_.rows()) return rest(i, values);
    const double span = table_.time_s[i + 1] - table_.time_s[i];
    const double s = (t - table_.time_s[i]) / span;
    const double share = stops_ ? minimum_jerk(s) : s;
    const double rate = (stops_ ? minimum_jerk_rate(s) : 1) / span;
    for (std::size_t j = 0; j < values.size(); ++j) {
      const double from = table_.row(i)[j % table_.joints];
      const double way = table_.row(i + 1)[j % table_.joints] - from;
      values[j].position = from + share * way;
      values[j].velocity = rate * way;
    }
  }

 private:
  void rest(std::size_t i, std::span<JointValue> values) const {
    for (std::size_t j = 0; j < values.size(); ++j) {
      values[j].position = table_.row(i)[j % table_.joints];
      values[j].velocity = 0;
    }
  }

  MotionTable table_;
  bool stops_;
  bool once_;
};

// The parameters of a form, with their defaults; refuses what is not in it.
Result<void> read_parameters(std::string_view form, std::string_view text, std::map<std::string, double>& values) {
  while (!text.empty()) {
    const std::size_t comma = text.find(',');
    const std::string_view item = text.substr(0, comma);
    const std::size_t equals = item.find('=');
    const std::string name(trimmed(item.substr(0, equals)));
    const auto found = values.find(name);
    if (found == values.end()) {
      std::vector<std::string> names;
      for (const auto& [key, value] : values) names.push_back(key);
      return fail(fmt::format("motion {}: there is no parameter '{}'", form, printable(name)),
                  fmt::format("its parameters: {}", fmt::join(names, ", ")));
    }
    const auto value = equals == std::string_view::npos ? std::nullopt : parse_number(trimmed(item.substr(equals + 1)));
    if (!value || std::abs(*value) > 1e9) {
      return fail(fmt::format("motion {}: '{}' is not a number", form, printable(item)), "write e.g. amplitude=0.5");
    }
    found->second = *value;
    text = comma == std::string_view::npos ? std::string_view{} : text.substr(comma + 1);
  }
  return {};
}

Result<std::unique_ptr<MotionSource>> from_file(std::string_view form, std::string_view text, std::size_t joints) {
  bool once = false;
  if (const std::string_view end = ",once"; text.ends_with(end)) {
    once = true;
    text.remove_suffix(end.size());
  }
  const std::string file(trimmed(text));
  if (file.empty()) return fail(fmt::format("motion {}: no file", form), fmt::format("write {}:FILE.csv", form));
  const auto content = read_text_file(file, kMostFileBytes);
  if (!content) return std::unexpected(content.error());
  Diagnostics diagnostics;
  MotionTable table = read_motion_table(*content, file, diagnostics);
  if (!diagnostics.ok()) return fail(diagnostics.text());
  if (table.joints < joints) {
    return fail(fmt::format("{} has {} values per row, the robot has {} joints", file, table.joints, joints));
  }
  return std::make_unique<Table>(std::move(table), form == "waypoints", once);
}

}  // namespace

Result<std::unique_ptr<MotionSource>> make_motion(std::string_view text, std::size_t joints) {
  const std::size_t colon = text.find(':');
  const std::string_view form = text.substr(0, colon);
  const std::string_view rest = colon == std::string_view::npos ? std::string_view{} : text.substr(colon + 1);
  if (form == "waypoints" || form == "recorded") return from_file(form, rest, joints);
  std::map<std::string, double> p;
  if (form == "hold") p = {{"position", 0.0}};
  if (form == "ramp") p = {{"velocity", 0.1}, {"offset", 0.0}};
  if (form == "sine") p = {{"amplitude", 0.5}, {"period", 4.0}, {"offset", 0.0}, {"phase", 0.0}, {"step", 0.0}};
  if (p.empty()) {
    return fail(fmt::format("there is no motion '{}'", printable(form)),
                "motions: hold, ramp, sine, waypoints:FILE.csv, recorded:FILE.csv");
  }
  if (auto read = read_parameters(form, rest, p); !read) return std::unexpected(read.error());
  if (form == "hold") return std::make_unique<Hold>(p["position"]);
  if (form == "ramp") return std::make_unique<Ramp>(p["velocity"], p["offset"]);
  if (p["period"] <= 0) return fail("motion sine: period must be above 0", "write e.g. period=4");
  return std::make_unique<Sine>(SineParameters{p["amplitude"], p["period"], p["offset"], p["phase"], p["step"]});
}

std::string motion_help() {
  return "  hold[:position=Q]                                    stands still\n  ramp[:velocity=V,offset=Q]            "
         "               Q + V t: a value identifies its time\n  sine[:amplitude=A,period=T,offset=Q,phase=P,step=S]  "
         "Q + A sin(2 pi t/T + P + j S), j = 0 for joint 1\n  waypoints:FILE.csv[,once]                            "
         "rests at each row, minimum jerk between rows\n  recorded:FILE.csv[,once]                             plays "
         "rows, linear between rows\n  Rows are time_s, q1, q2, ... in s and rad (or m); without `once` the file "
         "repeats.\n";
}

}  // namespace cellmirror::sim
