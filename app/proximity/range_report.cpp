#include "app/proximity/range_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/console/display_names.hpp"
#include "app/console/put.hpp"
#include "rt_core/base/counted.hpp"
#include "rt_core/base/microseconds.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace {

constexpr std::uint64_t kRangesListed = 12;  // frames that are shown one by one
constexpr std::size_t kMostNames = 200;

void add(JsonWriter& out, const RangeReading& reading) {
  const bool seen = reading.distance_m.has_value();
  out.begin_object().member("id", reading.id).member("path", reading.path).member("distance_m", reading.distance_m);
  if (seen) {
    out.member("point_m", reading.point_m).member("object", reading.object);
  } else {
    out.key("point_m").null().key("object").null();
  }
  out.member("in_blind_zone", reading.in_blind_zone);
  if (reading.doubtful) out.member("doubtful", true);
  out.end_object();
}

std::string reading_text(const RangeReading& reading) {
  const std::string id = printable(reading.id, kMostNames);
  const char* doubt = reading.doubtful ? ", in doubt" : "";
  if (!reading.distance_m) return fmt::format("  {:<12} nothing up to {:g} m{}\n", id, reading.range_m, doubt);
  return fmt::format("  {:<12} {:.4f} m  {} at {}{}{}\n", id, *reading.distance_m,
                     printable(reading.short_object, kMostNames), point_text(reading.point_m),
                     reading.in_blind_zone ? ", in the blind zone" : "", doubt);
}

}  // namespace

RangeJson::RangeJson(const RangeHeading& heading, const CompiledCell& cell, std::FILE* out) : cell_(cell), out_(out) {
  json_.begin_object().member("cell", heading.cell).key("frames").begin_array();
  hand_out();
}

void RangeJson::hand_out(std::string_view behind) { put(out_, "{}{}", json_.take(), behind); }

void RangeJson::frame(std::span<const RangeReading> readings) {
  json_.line().begin_object().key("sensors").begin_array();
  for (const RangeReading& reading : readings) add(json_, reading);
  json_.end_array().end_object();
  hand_out();
}

void RangeJson::end(const RangeTotals& totals) {
  json_.line().end_array().key("summary").begin_object().member("frames", totals.frames).key("sensors").begin_array();
  for (std::size_t i = 0; i < totals.sensors.size(); ++i) {
    const SensorTotals& sensor = totals.sensors[i];
    json_.begin_object()
        .member("id", cell_.sensors[i].name)
        .member("frames_seen", sensor.seen)
        .member("frames_in_blind_zone", sensor.in_blind_zone);
    if (sensor.seen > 0) {
      json_.member("smallest_m", sensor.smallest_m)
          .member("smallest_frame", sensor.smallest_frame)
          .member("largest_m", sensor.largest_m);
    } else {
      json_.key("smallest_m").null().key("smallest_frame").null().key("largest_m").null();
    }
    json_.end_object();
  }
  const HistogramSnapshot& times = totals.times;
  json_.end_array()
      .member("time_mean_us", microseconds(times.mean()))
      .member("time_p50_us", microseconds(times.percentile(50)))
      .member("time_p99_us", microseconds(times.percentile(99)))
      .member("time_max_us", microseconds(times.max()))
      .end_object()
      .end_object();
  hand_out("\n");
}

RangeText::RangeText(const RangeHeading& heading, const CompiledCell& cell, std::FILE* out)
    : heading_(heading), cell_(cell), out_(out) {
  put(out_, "{}: {} {}\n", printable(heading.cell), cell.sensors.size(),
      cell.sensors.size() == 1 ? "sensor" : "sensors");
}

void RangeText::frame(std::uint64_t number, std::span<const RangeReading> readings) {
  if (heading_.frames > kRangesListed) return;
  put(out_, "frame {}\n", number);
  for (const RangeReading& reading : readings) std::fputs(reading_text(reading).c_str(), out_);
}

void RangeText::end(const RangeTotals& totals) {
  put(out_, "\n{} {}\n", totals.frames, totals.frames == 1 ? "frame" : "frames");
  for (std::size_t i = 0; totals.frames > kRangesListed && i < totals.sensors.size(); ++i) {
    const SensorTotals& sensor = totals.sensors[i];
    const std::string id = printable(cell_.sensors[i].name, kMostNames);
    if (sensor.seen == 0) {
      put(out_, "  {:<12} nothing up to {:g} m\n", id, cell_.sensors[i].sensor.range_m);
      continue;
    }
    put(out_, "  {:<12} {} seen, {:.4f} .. {:.4f} m; nearest in frame {}: {}", id, sensor.seen, sensor.smallest_m,
        sensor.largest_m, sensor.smallest_frame, printable(sensor.smallest_object, kMostNames));
    if (sensor.in_blind_zone > 0) put(out_, "; {} in the blind zone", sensor.in_blind_zone);
    if (sensor.in_doubt > 0) put(out_, "; {} in doubt", sensor.in_doubt);
    put(out_, "\n");
  }
  const HistogramSnapshot& times = totals.times;
  put(out_, "time a frame: mean {:.0f}, median {:.0f}, p99 {:.0f}, max {:.0f} us\n", microseconds(times.mean()),
      microseconds(times.percentile(50)), microseconds(times.percentile(99)), microseconds(times.max()));
}

plot::Figure figure(const RangeHeading& heading, const CompiledCell& cell, const RangeTotals& totals) {
  constexpr std::size_t kMostLines = 16;  // that an eye can distinguish
  plot::Figure out;
  out.title = "Range sensors of " + printable(heading.cell);
  out.subtitle = fmt::format("{}, {}{}", number_of(totals.frames, "frame"), number_of(totals.sensors.size(), "sensor"),
                             totals.sensors.size() > kMostLines ? fmt::format(", the first {} drawn", kMostLines) : "");
  out.columns = 1;
  out.panel_width = 1400;
  plot::Panel panel;
  panel.title = "Readings; a gap: nothing in the cone";
  panel.x = {"frame", false, 1.0, static_cast<double>(std::max<std::uint64_t>(totals.frames, 2))};
  panel.y = {"distance [m]"};
  for (std::size_t i = 0; i < std::min(kMostLines, totals.sensors.size()); ++i) {
    const Envelope& distances = totals.sensors[i].distances;
    panel.lines.push_back({printable(cell.sensors[i].name), distances.numbers(), distances.values()});
  }
  out.panels.push_back(std::move(panel));
  return out;
}

}  // namespace cellmirror::app
