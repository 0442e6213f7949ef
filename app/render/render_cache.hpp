// What was drawn last for each kind of request, as long as it is requested. The memory of a picture goes on to the next
// one: a view that is turned by hand is another request with every picture, and each takes megabytes that stay locked.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "app/render/picture_request.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/image.hpp"
#include "rt_core/ports/picture_request.hpp"

namespace cellmirror::app {

struct RenderedPicture {
  PictureRequest request;
  std::uint64_t fingerprint = 0;
  std::uint64_t volume_fingerprint = 0;
  bool hasty = false;  // drawn with less than there is time for when voxel volumes rest: the next one may be better
  Timestamp drawn;
  Image image;
  Timestamp posture_time;
  std::vector<std::pair<int, std::shared_ptr<const EncodedImage>>> encoded;  // by quality
};

// The picture thread's.
class RenderCache {
 public:
  // Forgets what none of these requests uses any more; with no requests, everything.
  void keep(std::span<const PictureRequest> requests) {
    std::vector<RenderedPicture> kept;
    for (RenderedPicture& rendered : cache_) {
      const auto same = [&](const PictureRequest& request) { return same_drawing(request, rendered.request); };
      if (std::ranges::any_of(requests, same)) {
        kept.push_back(std::move(rendered));
      } else {
        spare_.push_back(std::move(rendered.image));
      }
    }
    cache_ = std::move(kept);
    const std::size_t more = requests.size() - std::min(requests.size(), cache_.size());
    if (spare_.size() > more) spare_.resize(more);
  }

  // What there is for `request`, or a new one. Until the next call of either.
  RenderedPicture& of(const PictureRequest& request) {
    const auto found = std::ranges::find_if(
        cache_, [&](const RenderedPicture& rendered) { return same_drawing(rendered.request, request); });
    if (found != cache_.end()) return *found;
    RenderedPicture& rendered = cache_.emplace_back();
    rendered.request = request;
    if (!spare_.empty()) {
      rendered.image = std::move(spare_.back());
      spare_.pop_back();
    }
    return rendered;
  }

  [[nodiscard]] std::size_t images() const { return cache_.size() + spare_.size(); }

 private:
  std::vector<RenderedPicture> cache_;
  std::vector<Image> spare_;
};

}  // namespace cellmirror::app
