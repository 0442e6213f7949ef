// Who looks at pictures continuously: one entry a client, with its newest picture. Newest wins, nobody waits.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/picture_request.hpp"

namespace cellmirror::app {

// Shared by a client and the picture thread.
class PictureObserver {
 public:
  PictureObserver(const PictureRequest& request, const Clock& clock) : clock_(clock), request_(request) { asked_now(); }

  // Any thread.
  [[nodiscard]] PictureRequest request() const;
  void change(const PictureRequest& request);
  // The picture of its request, if that is not the one it has already (`has`: its sequence). It may be an older one:
  // a picture for another client may have been drawn before.
  [[nodiscard]] std::shared_ptr<const EncodedImage> newest(std::uint64_t has);
  [[nodiscard]] std::string problem() const;

  // The picture thread's.
  // Not where it has changed its request from `request` meanwhile.
  void show(std::shared_ptr<const EncodedImage> picture, const PictureRequest& request);
  void report_problem(const Error& problem, const PictureRequest& request);
  // Whether it has asked within kObserverTimeout: for a client that stands still nothing is drawn.
  [[nodiscard]] bool looks(Timestamp now) const;
  // When the next one is due by its rate.
  Timestamp due;

  static constexpr Nanoseconds kObserverTimeout{1'000'000'000};

 private:
  void asked_now() { asked_ns_.store(clock_.now().ns, std::memory_order_relaxed); }

  const Clock& clock_;
  std::atomic<std::int64_t> asked_ns_{0};  // relaxed: only tells about when
  mutable std::mutex mutex_;               // of what follows
  PictureRequest request_;
  std::shared_ptr<const EncodedImage> newest_;
  std::string problem_;  // why there is no picture of the request; empty: there is one, or it is being drawn
};

// All of them. Any thread. `clock` outlives the streams.
class PictureStreams {
 public:
  static constexpr std::size_t kMost = 32;

  explicit PictureStreams(const Clock& clock) : clock_(clock) {}

  // Null where kMost are open.
  [[nodiscard]] std::unique_ptr<PictureStream> open(const PictureRequest& request);
  [[nodiscard]] std::vector<std::shared_ptr<PictureObserver>> all() const;
  [[nodiscard]] std::size_t size() const;

 private:
  const Clock& clock_;
  mutable std::mutex mutex_;
  mutable std::vector<std::weak_ptr<PictureObserver>> observers_;
};

}  // namespace cellmirror::app
