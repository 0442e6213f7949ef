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

#include "app/render/picture_counter.hpp"
#include "app/render/picture_streams.hpp"
#include "app/render/render_cache.hpp"
#include "app/render/render_quality.hpp"
#include "app/render/scene_source.hpp"
#include "app/snapshot/object_pool.hpp"
#include "app/snapshot/render_report.hpp"
#include "config/picture_settings.hpp"
#include "drivers/display/image_codec.hpp"
#include "drivers/display/renderer.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/image.hpp"
#include "rt_core/ports/picture_request.hpp"
#include "rt_core/rt/latency_histogram.hpp"
#include "rt_core/rt/wake_signal.hpp"

namespace cellmirror::app {

class RenderService {
 public:
  using RendererMaker = std::function<Result<std::unique_ptr<display::Renderer>>()>;

  // Pictures for an output of this process, at its rate, as long as output->watched().
  struct Output {
    std::unique_ptr<ImageOutput> output;
    PictureRequest request;
  };
  struct Options {
    PictureSettings settings;
    bool headless = false;  // no pictures at all
    std::vector<Output> outputs;
    RendererMaker make_renderer;  // empty: as the settings say
  };
  static constexpr std::size_t kMaxJobs = 16;

  // What `boards` and `updates` refer to outlives the renderer.
  RenderService(Options options, const SceneSource::Boards& boards, PictureCounter& updates);
  ~RenderService();
  RenderService(const RenderService&) = delete;
  RenderService& operator=(const RenderService&) = delete;

  // Any thread. The first time the renderer is made and the cell's meshes go to it, so that the first picture comes
  // sooner. Does not wait.
  void expect_pictures();
  // Any thread, as web::Backend. Does not wait.
  Result<std::unique_ptr<PictureStream>> open_pictures(const PictureRequest& request);
  // `reply` is called once, by the picture's thread, or at once where the request is refused.
  void ask_picture(const PictureRequest& request, ImageFormat format, PictureReply reply);
  void ask_pick(const PictureRequest& request, int x, int y, PickReply reply);

  [[nodiscard]] RenderReport report() const;
  [[nodiscard]] RendererCounters counters() const;  // of the newest picture
  // The names and counters of the outputs; they are there as long as the renderer.
  [[nodiscard]] std::vector<const ImageOutput*> outputs() const;
  [[nodiscard]] const PictureSettings& settings() const { return options_.settings; }

 private:
  using Job = std::function<void(bool given_up)>;

  // A client or output whose picture is due in this round.
  struct Recipient {
    std::shared_ptr<PictureObserver> observer;  // null: an output
    Output* output = nullptr;
    PictureRequest request;
  };

  [[nodiscard]] Result<void> refusal(const PictureRequest& request) const;
  bool add_job(Job job);
  void loop(const std::stop_token& stop);
  // One of them. False: there is none.
  bool run_job();
  void cancel_jobs();
  // `early`: between two rounds, since SCRIPT has changed how volumes are drawn; no update of the display.
  void round(Timestamp now, bool early);
  // A client looks at a cell with voxel volumes.
  [[nodiscard]] bool looks_for_volumes() const;
  // A change of volumes by SCRIPT is to be drawn before the next round; at most once in its time.
  [[nodiscard]] bool volumes_wait(Timestamp now) const;
  // A trace has a point for each scene that was joined, so one is, also where nobody looks.
  [[nodiscard]] std::vector<Recipient> recipients(Timestamp now, bool early);
  // Of all who look, also of those who get no picture in this round.
  [[nodiscard]] std::vector<PictureRequest> requests(Timestamp now) const;
  // Different pictures a second that are requested.
  [[nodiscard]] double requested_hz(std::span<const PictureRequest> requests) const;
  void serve(const std::vector<Recipient>& recipients);
  void give(const Recipient& recipient, RenderedPicture& rendered);
  static void report_problem(const std::vector<Recipient>& recipients, const Error& problem);
  Result<void> bring_up_to_date(RenderedPicture& rendered);
  Result<std::shared_ptr<const EncodedImage>> encode(RenderedPicture& rendered, int quality);

  Result<EncodedImage> take(const PictureRequest& request, ImageFormat format);
  Result<std::optional<PickedObject>> look_at(const PictureRequest& request, int x, int y);
  // The newest scene, and the renderer; fails where there is none.
  Result<std::vector<Pane>> prepare(const PictureRequest& request);
  Result<void> need_renderer();
  // What a picture may take beside what it has to; as Renderer::draw().
  struct PictureEffort {
    bool smooth = true;
    Nanoseconds volume_time{0};
  };
  Result<void> draw(std::span<const Pane> panes, int width, int height, Image& image, PictureEffort effort);
  void note_problem(const Error& error);
  void clear_problem();
  void count(std::uint64_t RenderReport::* counter);

  Options options_;
  SceneSource::Boards boards_;
  PictureCounter& updates_;
  PictureStreams streams_;

  // The picture thread's own.
  SceneSource source_;
  std::unique_ptr<display::Renderer> renderer_;
  Timestamp renderer_tried_;
  display::ImageEncoder encoder_;
  RenderQuality effort_;
  Timestamp last_early_;
  Nanoseconds volume_time_{0};  // for casting volumes in a picture of this round
  RenderCache cache_;
  std::vector<Timestamp> output_due_;
  std::uint64_t sequence_ = 0;
  ObjectPool<EncodedImage> recycled_;

  LatencyHistogram scene_time_;
  LatencyHistogram draw_time_;
  LatencyHistogram encode_time_;
  LatencyHistogram age_;
  mutable std::mutex mutex_;  // of what follows
  std::deque<Job> jobs_;
  bool ended_ = false;
  bool expected_ = false;  // expect_pictures() was called
  RenderReport report_;

  WakeSignal wake_;
  std::jthread thread_;  // last: it uses everything above
};

}  // namespace cellmirror::app
