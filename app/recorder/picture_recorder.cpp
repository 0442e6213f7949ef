#include "app/recorder/picture_recorder.hpp"

#include <algorithm>
#include <utility>

#include "app/recorder/output_messages.hpp"
#include "drivers/dds/image_message.hpp"
#include "drivers/dds/ros2_messages.hpp"
#include "drivers/dds/sensor_ranges.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace {

constexpr Nanoseconds kBetweenUpdates{200'000'000};

bool is_number(std::string_view view) { return view.size() == 1 && view.front() >= '0' && view.front() <= '6'; }

PictureRequest request_of(const std::string& view, double rate_hz) {
  PictureRequest request;
  if (is_number(view)) {
    request.view = view.front() - '0';
  } else {
    request.camera = view;
  }
  request.rate_hz = rate_hz;
  return request;
}

}  // namespace

std::string pictures_topic_name(std::string_view view) {
  constexpr std::string_view kPrefix = "/cellmirror/pictures";
  if (is_number(view)) return std::string(kPrefix) + "/view_" + std::string(view);
  return dds::topic_of("camera", kPrefix, view);
}

void PictureRecorder::look(Timestamp now) {
  if (!open_) return;
  if (!last_update_.known() || now - last_update_ >= kBetweenUpdates) {
    last_update_ = now;
    update_views();
  }
  for (auto& [name, view] : views_) take_picture(name, view);
}

void PictureRecorder::update_views() {
  const std::vector<WantedPicture> wanted = hub_.pictures();
  std::erase_if(views_, [&](const auto& known) {
    return std::ranges::find(wanted, known.first, &WantedPicture::view) == wanted.end();
  });
  for (const WantedPicture& one : wanted) {
    View& view = views_[one.view];
    if (view.rate_hz == one.rate_hz) continue;
    view.rate_hz = one.rate_hz;
    if (!view.topic) view.topic = OutputTopics::pictures(one.view);
    open(one.view, view);
  }
}

void PictureRecorder::open(const std::string& name, View& view) {
  const PictureRequest request = request_of(name, view.rate_hz);
  if (view.stream) return view.stream->change(request);
  auto stream = open_(request);
  if (!stream)
    return log_warning("recording", "there are no pictures of {}: {}", printable(name), stream.error().text());
  view.stream = *std::move(stream);
}

void PictureRecorder::take_picture(const std::string& name, View& view) {
  if (!view.stream) return;
  const std::shared_ptr<const EncodedImage> picture = view.stream->newest(view.newest);
  if (!picture) {
    std::string problem = view.stream->problem();
    if (!problem.empty() && problem != view.problem)
      log_warning("recording", "there are no pictures of {}: {}", printable(name), problem);
    view.problem = std::move(problem);
    return;
  }
  if (picture->sequence == view.newest) return;
  view.newest = picture->sequence;
  const std::int64_t wall_ns = to_wall_clock_ns(picture->posture_time);
  dds::CompressedImage message;
  message.header.stamp = dds::ros_time(wall_ns);
  message.header.frame_id = name;
  message.data = picture->bytes;
  encode(message, bytes_);
  hub_.put(view.topic, wall_ns, bytes_);
}

}  // namespace cellmirror::app
