// What was drawn last for each kind of wish, as long as somebody has it. The memory of a picture goes on to the next
// one: a view that is turned by hand is another wish with every picture, and each takes megabytes that stay locked.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "app/gateway/picture_wish.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/image.hpp"
#include "rt_core/ports/picture_request.hpp"

namespace cellmirror::app {

struct Shot {
  PictureRequest wish;
  std::uint64_t fingerprint = 0;
  Timestamp drawn;
  Image image;
  Timestamp posture_time;
  std::vector<std::pair<int, std::shared_ptr<const EncodedImage>>> encoded;  // by quality
};

// The picture thread's.
class Shots {
 public:
  // Forgets what none of these wishes any more; with no wishes, everything.
  void keep(std::span<const PictureRequest> wishes) {
    std::vector<Shot> kept;
    for (Shot& shot : shots_) {
      const auto same = [&](const PictureRequest& wish) { return same_drawing(wish, shot.wish); };
      if (std::ranges::any_of(wishes, same)) {
        kept.push_back(std::move(shot));
      } else {
        spare_.push_back(std::move(shot.image));
      }
    }
    shots_ = std::move(kept);
    const std::size_t more = wishes.size() - std::min(wishes.size(), shots_.size());
    if (spare_.size() > more) spare_.resize(more);
  }

  // What there is for `wish`, or a new one. Until the next call of either.
  Shot& of(const PictureRequest& wish) {
    const auto found = std::ranges::find_if(shots_, [&](const Shot& shot) { return same_drawing(shot.wish, wish); });
    if (found != shots_.end()) return *found;
    Shot& shot = shots_.emplace_back();
    shot.wish = wish;
    if (!spare_.empty()) {
      shot.image = std::move(spare_.back());
      spare_.pop_back();
    }
    return shot;
  }

  [[nodiscard]] std::size_t images() const { return shots_.size() + spare_.size(); }

 private:
  std::vector<Shot> shots_;
  std::vector<Image> spare_;
};

}  // namespace cellmirror::app
