#include "app/recorder/tissue_recorder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/io/tissue_publisher.hpp"
#include "app/recorder/output_messages.hpp"
#include "app/snapshot/tissue_names.hpp"
#include "drivers/dds/ros2_messages.hpp"

namespace cellmirror::app {

namespace {

constexpr Nanoseconds kBetweenShapes{5'000'000'000};  // a seek reads from 11 s before its time
constexpr Nanoseconds kBetweenMarkers{500'000'000};   // they are large
constexpr std::size_t kMostMarkerTriangles = 2'000;   // of all objects, 72 bytes each
constexpr std::int64_t kMarkerLifetime_ns = 2'000'000'000;
constexpr std::size_t kMostObjects = 64;

bool has_passed(Timestamp now, Timestamp last, Nanoseconds period) {
  // A time before the last one: a recording that is played was set back.
  return !last.known() || now < last || now - last >= period;
}

}  // namespace

TissueRecorder::TissueRecorder(TissueSources sources, RecordingHub& hub)
    : sources_(std::move(sources)),
      hub_(hub),
      events_topic_(OutputTopics::tissue_events()),
      markers_topic_(OutputTopics::tissue_markers()),
      markers_(kMostMarkerTriangles, kMarkerLifetime_ns) {
  effects_.topic = OutputTopics::tissue_effects();
}

void TissueRecorder::forget() {
  newest_event_.reset();
  repeat_shapes();
}

void TissueRecorder::repeat_shapes() {
  // Revisions go on: a file that goes on has those of before.
  for (auto& [object, written] : surfaces_) written.with_shape = {};
  effects_.with_shape = {};
  last_step_ = 0;
}

// Which objects there are is known from the first shapes on.
bool TissueRecorder::wanted() const {
  // Both are asked, so that clients that watch live get to know the topics.
  const bool effects = hub_.wants(*effects_.topic);
  return hub_.wants(*markers_topic_) || effects || surfaces_.empty() ||
         std::ranges::any_of(surfaces_, [&](const auto& one) { return hub_.wants(*one.second.topic); });
}

// Records events at any rate of shapes, because they are few.
void TissueRecorder::record_events(const CellState& cell) {
  const std::shared_ptr<const TissueReport> report = sources_.newest_report();
  if (!report) return;
  const std::vector<TissueEvent>& events = report->state.events;
  const std::uint64_t newest = events.empty() ? 0 : events.back().number;
  // A new simulation restarts the numbers.
  if (!newest_event_ || newest < *newest_event_) newest_event_ = newest;
  const bool wanted = hub_.wants(*events_topic_);  // asked at each look, so that live clients learn of the topic
  for (const TissueEvent& event : events) {
    if (event.number <= *newest_event_ || !wanted) continue;
    const NamedTissueEvent named{event, robot_name(cell, event.instrument), object_name(report->state, event.object)};
    const std::int64_t wall_ns = to_wall_clock_ns(event.time);
    const std::string text = tissue_event_message(named, sentence(named), wall_ns);
    hub_.put(events_topic_, wall_ns, mcap::view_of(text));
  }
  newest_event_ = newest;
}

void TissueRecorder::look(Timestamp now, const CellState* cell) {
  if (cell != nullptr) record_events(*cell);
  if (!sources_.view) return;
  const double rate_hz = hub_.tissue_rate_hz();
  if (!(rate_hz > 0)) return;
  // A recording that is played has a view for each recorded one, and its time may stand still.
  const bool played = sources_.report == nullptr;
  if (!played && !has_passed(now, last_look_, Nanoseconds(std::llround(1e9 / rate_hz)))) return;
  if (!wanted()) return;
  const std::shared_ptr<const TissueView> view = sources_.view();
  if (!view) return;
  const std::uint64_t files = hub_.files_begun();
  const bool begun = std::exchange(files_, files) != files;
  if (begun) repeat_shapes();
  // Tissue that stands still has its shapes again from time to time, for seeks.
  if (view->step == last_step_ && !begun && (played || !has_passed(now, last_shapes_, kBetweenShapes))) return;
  last_step_ = view->step;
  last_look_ = now;
  const auto report = sources_.newest_report();
  TissueHead head;
  head.step = view->step;
  head.time = report && report->state.time.known() ? report->state.time : now;
  const std::int64_t wall_ns = to_wall_clock_ns(head.time);
  for (const TissueSurface& surface : view->surfaces) record_surface(surface, head, now, wall_ns);
  record_effects(*view, head, now, wall_ns);
  if (played || has_passed(now, last_markers_, kBetweenMarkers)) record_markers(*view, now, wall_ns);
}

bool TissueRecorder::take_shape(Written& written, std::vector<std::shared_ptr<const void>> shape, Timestamp now) const {
  if (written.shape != shape) {
    written.shape = std::move(shape);
    ++written.revision;
    written.with_shape = {};
  }
  return has_passed(now, written.with_shape, kBetweenShapes);
}

void TissueRecorder::record_surface(const TissueSurface& surface, TissueHead head, Timestamp now,
                                    std::int64_t wall_ns) {
  auto found = surfaces_.find(surface.name);
  if (found == surfaces_.end()) {
    if (surfaces_.size() >= kMostObjects) return;
    found = surfaces_.emplace(surface.name, Written{}).first;
    found->second.topic = OutputTopics::tissue(surface.name);
  }
  Written& written = found->second;
  if (!hub_.wants(*written.topic)) return;
  const bool due = take_shape(written, {surface.topology}, now);
  head.revision = written.revision;
  if (!encode_surface(head, surface, bytes_)) return hub_.count_missed(written.topic, 1);
  if (!due && same_but_for_time(bytes_, written.moving)) return;
  written.moving = bytes_;
  if (due) {
    head.has_shape = true;
    if (!encode_surface(head, surface, bytes_)) return;
    written.with_shape = last_shapes_ = now;
  }
  hub_.put(written.topic, wall_ns, bytes_);
}

void TissueRecorder::record_effects(const TissueView& view, TissueHead head, Timestamp now, std::int64_t wall_ns) {
  if (!hub_.wants(*effects_.topic)) return;
  std::vector<std::shared_ptr<const void>> shape;
  for (const TissueClip& clip : view.clips) {
    shape.push_back(clip.vertices);
    shape.push_back(clip.triangles);
  }
  const bool due = take_shape(effects_, std::move(shape), now);
  head.revision = effects_.revision;
  encode_tissue_effects(head, view, bytes_);
  if (!due && same_but_for_time(bytes_, effects_.moving)) return;
  effects_.moving = bytes_;
  if (due) {
    head.has_shape = true;
    encode_tissue_effects(head, view, bytes_);
    effects_.with_shape = last_shapes_ = now;
  }
  hub_.put(effects_.topic, wall_ns, bytes_);
}

void TissueRecorder::record_markers(const TissueView& view, Timestamp now, std::int64_t wall_ns) {
  if (!hub_.wants(*markers_topic_)) return;
  last_markers_ = now;
  markers_.fill(dds::ros_time(wall_ns), view, {}, marker_message_);
  if (marker_message_.markers.empty()) return;
  encode(marker_message_, bytes_);
  hub_.put(markers_topic_, wall_ns, bytes_);
}

}  // namespace cellmirror::app
