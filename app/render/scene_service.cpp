#include "app/render/scene_service.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/render/picked_object.hpp"
#include "app/render/picture_rate.hpp"
#include "app/render/scene_fingerprint.hpp"
#include "app/render/scene_message.hpp"
#include "rt_core/rt/scheduling.hpp"

namespace cellmirror::app {

namespace {

constexpr Nanoseconds kClientTimeout{1'000'000'000};  // for a client that does not ask for so long nothing is made
constexpr Nanoseconds kAgainAfter{950'000'000};       // what has not changed is sent again after this time, for its age
constexpr Nanoseconds kMarksPeriod{200'000'000};      // of words: at most so often
constexpr Nanoseconds kGeometryPeriod{250'000'000};   // of files: a script may load many components
constexpr Nanoseconds kLookAgain{100'000'000};        // whether a client that was silent asks again
constexpr Nanoseconds kIdle{10'000'000'000};          // opening a stream wakes

constexpr const char* kServiceEnding = "the gateway is ending";

bool same_body(const SceneBody& a, const SceneBody& b) {
  return a.object == b.object && a.shape == b.shape && a.mesh == b.mesh && a.size == b.size && a.rgba == b.rgba;
}

}  // namespace

class SceneService::Stream final : public SceneStream {
 public:
  Stream(std::shared_ptr<Shared> shared, const Clock& clock) : shared_(std::move(shared)), clock_(clock) { asked(); }
  ~Stream() override { shared_->streams.fetch_sub(1, std::memory_order_relaxed); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  [[nodiscard]] std::shared_ptr<const SceneUpdate> newest(std::uint64_t has) const override {
    asked();
    const std::scoped_lock lock(shared_->mutex);
    return shared_->newest && shared_->newest->sequence != has ? shared_->newest : nullptr;
  }

 private:
  void asked() const { shared_->asked_ns.store(clock_.now().ns, std::memory_order_relaxed); }

  std::shared_ptr<Shared> shared_;
  const Clock& clock_;
};

SceneService::SceneService(double rate_hz, const SceneSource::Boards& boards)
    : boards_(boards), period_(picture_period(std::min(rate_hz, kHighestPictureRate))), source_(boards) {
  thread_ = std::jthread([this](const std::stop_token& stop) { loop(stop); });
}

SceneService::~SceneService() {
  thread_.request_stop();
  wake_.wake();
  thread_.join();
}

Result<std::unique_ptr<SceneStream>> SceneService::open() {
  if (shared_->streams.fetch_add(1, std::memory_order_relaxed) >= kMaxStreams) {
    shared_->streams.fetch_sub(1, std::memory_order_relaxed);
    return fail(fmt::format("{} pages show the cell already", kMaxStreams), "close a page that is not needed");
  }
  auto stream = std::make_unique<Stream>(shared_, boards_.clock);
  wake_.wake();
  return stream;
}

void SceneService::ask_geometry(GeometryReply reply) {
  {
    const std::scoped_lock lock(mutex_);
    if (!ended_ && waiting_.size() < kMaxWaiting) {
      waiting_.push_back(std::move(reply));
      reply = nullptr;
    }
  }
  if (reply) return reply(fail("too many wait for the geometry of the cell", "ask again in a moment"));
  wake_.wake();
}

bool SceneService::watched(Timestamp now) const {
  if (shared_->streams.load(std::memory_order_relaxed) == 0) return false;
  return now - Timestamp{shared_->asked_ns.load(std::memory_order_relaxed)} < kClientTimeout;
}

void SceneService::loop(const std::stop_token& stop) {
  set_thread_name("scene");
  Timestamp next = boards_.clock.now();
  while (!stop.stop_requested()) {
    const Timestamp now = boards_.clock.now();
    if (is_waited_for()) answer_waiting(now);
    if (!watched(now)) {
      forget();
      wake_.wait(shared_->streams.load(std::memory_order_relaxed) > 0 ? kLookAgain : kIdle);
      next = boards_.clock.now();
      continue;
    }
    if (now >= next) {
      update(now);
      next = std::max(next + period_, boards_.clock.now());
    }
    wake_.wait(std::max(Nanoseconds{0}, next - boards_.clock.now()));
  }
  std::vector<GeometryReply> left;
  {
    const std::scoped_lock lock(mutex_);
    ended_ = true;
    left.swap(waiting_);
  }
  for (const GeometryReply& reply : left) reply(fail(kServiceEnding));
}

// A client that comes back gets an update that is made then, not an old one.
void SceneService::forget() {
  if (last_ == nullptr) return;
  last_.reset();
  std::shared_ptr<const SceneUpdate> shown;
  const std::scoped_lock lock(shared_->mutex);
  shared_->newest.swap(shown);
}

bool SceneService::is_waited_for() {
  const std::scoped_lock lock(mutex_);
  return !waiting_.empty();
}

void SceneService::answer_waiting(Timestamp now) {
  std::vector<GeometryReply> waiting;
  {
    const std::scoped_lock lock(mutex_);
    waiting.swap(waiting_);
  }
  if (source_.refresh()) update_geometry(now);
  for (const GeometryReply& reply : waiting) {
    if (geometry_)
      reply(geometry_);
    else
      reply(fail("the cell is not there yet", "ask again in a moment"));
  }
}

bool SceneService::same_bodies() const {
  return geometry_ != nullptr && built_names_ == source_.cell().paths &&
         std::ranges::equal(built_bodies_, source_.scene().bodies, same_body);
}

void SceneService::update_geometry(Timestamp now) {
  if (same_bodies() || (built_.known() && now - built_ < kGeometryPeriod)) return;
  built_ = now;
  const CompiledCell& cell = source_.cell();
  auto made = std::make_shared<SceneGeometry>();
  made->glb = export_.make(source_.scene().bodies, [&](std::uint32_t object) {
    const auto named = picked_object(cell, object);
    return named ? display::BodyName{named->path, named->robot} : display::BodyName{};
  });
  made->hash = content_hash(made->glb);
  geometry_ = std::move(made);
  built_bodies_ = source_.scene().bodies;
  built_names_ = cell.paths;
}

void SceneService::update(Timestamp now) {
  if (!source_.refresh()) return;
  update_geometry(now);
  // Too soon for another file: poses of these bodies would belong to none.
  if (!same_bodies()) return;
  publish(scene_poses(source_.scene(), source_.cameras()), now);
}

void SceneService::add_tissue(SceneUpdate& update) {
  const std::shared_ptr<const TissueView>& view = source_.scene().tissue;
  if (!view) {
    tissue_shown_.reset();
    return;
  }
  TissueShapeKey key = tissue_shape_key(*view);
  if (!tissue_shape_ || key != tissue_key_) {
    tissue_key_ = std::move(key);
    tissue_shape_ = std::make_shared<const std::string>(tissue_shape(*view, ++tissue_number_));
  }
  update.tissue_number = tissue_number_;
  update.tissue_shape = tissue_shape_;
  // As it was, where only something else has changed.
  update.tissue_motion = view == tissue_shown_ && last_ && last_->tissue_motion
                             ? last_->tissue_motion
                             : std::make_shared<const std::string>(tissue_motion(*view, tissue_number_));
  tissue_shown_ = view;
}

void SceneService::publish(std::string poses, Timestamp now) {
  std::shared_ptr<const std::string> marks = last_ ? last_->marks : nullptr;
  std::uint64_t marks_sequence = last_ ? last_->marks_sequence : 0;
  if (!marks || now - marked_ >= kMarksPeriod) {
    marked_ = now;
    auto made = std::make_shared<const std::string>(scene_marks(source_.scene(), source_.cell(), source_.cameras()));
    if (!marks || *marks != *made) {
      marks = std::move(made);
      marks_sequence = static_cast<std::uint64_t>(now.ns);  // grows, also over times without clients
    }
  }
  const bool same = last_ && last_->geometry_hash == geometry_->hash && last_->marks_sequence == marks_sequence &&
                    last_->poses == poses && tissue_shown_ == source_.scene().tissue;
  if (same && now - published_ < kAgainAfter) return;
  auto made = std::make_shared<SceneUpdate>();
  made->sequence = static_cast<std::uint64_t>(now.ns);
  made->posture_time = source_.scene().posture_time;
  made->geometry_hash = geometry_->hash;
  made->poses = std::move(poses);
  made->marks_sequence = marks_sequence;
  made->marks = std::move(marks);
  add_tissue(*made);
  published_ = now;
  last_ = std::move(made);
  std::shared_ptr<const SceneUpdate> shown = last_;
  const std::scoped_lock lock(shared_->mutex);
  shared_->newest.swap(shown);
}

}  // namespace cellmirror::app
