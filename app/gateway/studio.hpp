// Takes the pictures of the running cell, in a thread of its own that never holds up anything: for the monitor page,
// for `cellmirror snapshot`, for DDS. Nobody looks: nothing is drawn. One drawing serves all who wish the same; what
// has not changed is not drawn again, but once a second. docs/pictures.md.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "app/gateway/picture_effort.hpp"
#include "app/gateway/picture_streams.hpp"
#include "app/gateway/picture_updates.hpp"
#include "app/gateway/recycler.hpp"
#include "app/gateway/scene_source.hpp"
#include "app/gateway/shots.hpp"
#include "app/gateway/wake_signal.hpp"
#include "config/picture_settings.hpp"
#include "drivers/display/image_codec.hpp"
#include "drivers/display/renderer.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/image.hpp"
#include "rt_core/ports/picture_request.hpp"
#include "rt_core/rt/latency_histogram.hpp"

namespace cellmirror::app {

// All that status tells of it, as of one moment.
struct PictureReport {
  bool on = false;
  std::string renderer;  // its own name; empty: it was not needed yet
  std::string problem;   // why there are no pictures; empty: there is nothing wrong
  PictureSettings settings;
  std::size_t streams = 0;
  std::uint64_t updates = 0;
  std::uint64_t drawn = 0;
  std::uint64_t unchanged = 0;  // drawings that were left out because nothing had changed
  std::uint64_t on_demand = 0;  // pictures and picks, of `drawn`
  std::uint64_t in_haste = 0;   // without anti-aliasing, of `drawn`: there was no time for it
  std::uint64_t failed = 0;
  display::RendererCounters counters;
  HistogramSnapshot scene;   // how long it took to join the scene,
  HistogramSnapshot draw;    // to draw it,
  HistogramSnapshot encode;  // to encode it
  HistogramSnapshot age;     // of the posture shown, when the picture could be had
};

class Studio {
 public:
  using RendererMaker = std::function<Result<std::unique_ptr<display::Renderer>>()>;

  // Pictures for somebody within the process, at his rate, as long as output->watched().
  struct Output {
    std::unique_ptr<ImageOutput> output;
    PictureRequest wish;
  };
  struct Options {
    PictureSettings settings;
    bool headless = false;  // no pictures at all
    std::vector<Output> outputs;
    RendererMaker make_renderer;  // empty: as the settings say
  };
  static constexpr std::size_t kMostJobs = 16;

  // What `boards` and `updates` refer to outlives the studio.
  Studio(Options options, const SceneSource::Boards& boards, PictureUpdates& updates);
  ~Studio();
  Studio(const Studio&) = delete;
  Studio& operator=(const Studio&) = delete;

  // Any thread. The first time the renderer is made and the cell's meshes go to it, so that the first picture comes
  // sooner. Does not wait.
  void expect_pictures();
  // Any thread, as web::Backend. Does not wait.
  Result<std::unique_ptr<PictureStream>> open_pictures(const PictureRequest& wish);
  // `reply` is called once, by the picture's thread, or at once where the wish is refused.
  void ask_picture(const PictureRequest& wish, ImageFormat format, PictureReply reply);
  void ask_pick(const PictureRequest& wish, int x, int y, PickReply reply);

  [[nodiscard]] PictureReport report() const;
  // The names and counters of the outputs; they are there as long as the studio.
  [[nodiscard]] std::vector<const ImageOutput*> outputs() const;
  [[nodiscard]] const PictureSettings& settings() const { return options_.settings; }

 private:
  using Job = std::function<void(bool given_up)>;

  // Somebody who gets a picture in this round.
  struct Guest {
    std::shared_ptr<Looker> looker;  // null: an output
    Output* output = nullptr;
    PictureRequest wish;
  };

  [[nodiscard]] Result<void> refusal(const PictureRequest& wish) const;
  bool add_job(Job job);
  void loop(const std::stop_token& stop);
  // One of them. False: there is none.
  bool run_job();
  void give_up_jobs();
  void round(Timestamp now);
  // A trace has a point for each scene that was joined, so one is, also where nobody looks.
  void follow_traces();
  [[nodiscard]] std::vector<Guest> guests(Timestamp now);
  // Of all who look, also of those who get no picture in this round.
  [[nodiscard]] std::vector<PictureRequest> wishes(Timestamp now) const;
  // Different pictures a second that are wished for.
  [[nodiscard]] double wished_hz(std::span<const PictureRequest> wishes) const;
  void serve(const std::vector<Guest>& guests);
  void give(const Guest& guest, Shot& shot);
  static void tell(const std::vector<Guest>& guests, const Error& problem);
  Result<void> bring_up_to_date(Shot& shot);
  Result<std::shared_ptr<const EncodedImage>> encode(Shot& shot, int quality);

  Result<EncodedImage> take(const PictureRequest& wish, ImageFormat format);
  Result<std::optional<PickedObject>> look_at(const PictureRequest& wish, int x, int y);
  // The newest scene, and the renderer; fails where there is none.
  Result<std::vector<Pane>> prepare(const PictureRequest& wish);
  Result<void> need_renderer();
  Result<void> draw(std::span<const Pane> panes, int width, int height, Image& image, bool smooth);
  void note_problem(const Error& error);
  void note_well();
  void count(std::uint64_t PictureReport::* counter);

  Options options_;
  SceneSource::Boards boards_;
  PictureUpdates& updates_;
  PictureStreams streams_;

  // The picture thread's own.
  SceneSource source_;
  std::unique_ptr<display::Renderer> renderer_;
  Timestamp renderer_tried_;
  display::ImageEncoder encoder_;
  PictureEffort effort_;
  Shots shots_;
  std::vector<Timestamp> output_due_;
  std::uint64_t sequence_ = 0;
  Recycler<EncodedImage> recycled_;

  LatencyHistogram scene_time_;
  LatencyHistogram draw_time_;
  LatencyHistogram encode_time_;
  LatencyHistogram age_;
  mutable std::mutex mutex_;  // of what follows
  std::deque<Job> jobs_;
  bool ended_ = false;
  bool expected_ = false;  // expect_pictures() was called
  PictureReport report_;

  WakeSignal wake_;
  std::jthread thread_;  // last: it uses everything above
};

}  // namespace cellmirror::app
