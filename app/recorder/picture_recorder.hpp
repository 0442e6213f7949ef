// Gives pictures of views to the recordings that want them: the JPEG that a client of the page gets, at a low rate.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/recorder/recording_hub.hpp"
#include "app/recorder/topic.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/picture_request.hpp"

namespace cellmirror::app {

// "/cellmirror/pictures/view_1", "/cellmirror/pictures/CAMERA".
[[nodiscard]] std::string pictures_topic_name(std::string_view view);

// The recorder's thread. It waits for no picture.
class PictureRecorder {
 public:
  using Open = std::function<Result<std::unique_ptr<PictureStream>>(const PictureRequest& request)>;

  // `hub` outlives it.
  PictureRecorder(Open open, RecordingHub& hub) : open_(std::move(open)), hub_(hub) {}

  // To be called at least twice a second, so that pictures are drawn.
  void look(Timestamp now);

 private:
  struct View {
    double rate_hz = 0;
    TopicPtr topic;
    std::unique_ptr<PictureStream> stream;  // null: it could not be opened
    std::uint64_t newest = 0;               // sequence of the last picture
    std::string problem;                    // that was logged
  };

  void update_views();
  void open(const std::string& name, View& view);
  void take_picture(const std::string& name, View& view);

  Open open_;
  RecordingHub& hub_;
  std::map<std::string, View> views_;
  Timestamp last_update_;
  std::vector<std::byte> bytes_;
};

}  // namespace cellmirror::app
