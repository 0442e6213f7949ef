// The running cell for clients that draw it themselves: its geometry as a file, its poses as a stream. In a thread of
// its own, so that pictures, which take longer, do not hold up poses. Nobody looks: nothing is made.
// docs/monitor-page.md.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "app/render/scene_source.hpp"
#include "app/render/tissue_message.hpp"
#include "drivers/display/geometry_export.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/scene_stream.hpp"
#include "rt_core/rt/wake_signal.hpp"

namespace cellmirror::app {

class SceneService {
 public:
  static constexpr std::size_t kMaxStreams = 32;
  static constexpr std::size_t kMaxWaiting = 16;  // who waits for geometry

  // `rate_hz`: of updates, at most. What `boards` refer to outlives the service; `boards.ticks` is read by it alone.
  SceneService(double rate_hz, const SceneSource::Boards& boards);
  ~SceneService();
  SceneService(const SceneService&) = delete;
  SceneService& operator=(const SceneService&) = delete;

  // Any thread. Do not wait.
  Result<std::unique_ptr<SceneStream>> open();
  // `reply` is called once, by the service's thread, or at once where it is refused.
  void ask_geometry(GeometryReply reply);

 private:
  class Stream;
  // Shared with the streams, which may outlive the service.
  struct Shared {
    std::atomic<std::int64_t> asked_ns{0};  // when a client asked last; relaxed: only tells about when
    std::atomic<std::uint64_t> streams{0};
    std::mutex mutex;  // of what follows
    std::shared_ptr<const SceneUpdate> newest;
  };

  void loop(const std::stop_token& stop);
  [[nodiscard]] bool watched(Timestamp now) const;
  void answer_waiting(Timestamp now);
  [[nodiscard]] bool is_waited_for();
  void forget();
  void update(Timestamp now);
  // Of the scene as it is; the file is kept while the bodies are the same.
  void update_geometry(Timestamp now);
  [[nodiscard]] bool same_bodies() const;
  // Of the newest update, or made now: the part of deformable objects.
  void add_tissue(SceneUpdate& update);
  void publish(std::string poses, Timestamp now);

  SceneSource::Boards boards_;
  Nanoseconds period_;
  std::shared_ptr<Shared> shared_ = std::make_shared<Shared>();

  // The thread's own.
  SceneSource source_;
  display::GeometryExport export_;
  std::vector<SceneBody> built_bodies_;  // of the file
  std::shared_ptr<const void> built_names_;
  std::shared_ptr<const SceneGeometry> geometry_;
  Timestamp built_;
  TissueShapeKey tissue_key_;  // of the newest shape
  std::uint32_t tissue_number_ = 0;
  std::shared_ptr<const std::string> tissue_shape_;
  std::shared_ptr<const TissueView> tissue_shown_;  // of the newest motion
  std::shared_ptr<const SceneUpdate> last_;
  Timestamp published_;
  Timestamp marked_;

  std::mutex mutex_;  // of what follows
  std::vector<GeometryReply> waiting_;
  bool ended_ = false;

  WakeSignal wake_;
  std::jthread thread_;  // last: it uses everything above
};

}  // namespace cellmirror::app
