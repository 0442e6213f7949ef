#include "app/playback/played_tissue.hpp"

#include <algorithm>
#include <utility>

#include "app/recording_layout/recording_names.hpp"

namespace cellmirror::app {

bool is_of_tissue(const mcap::Channel& channel) {
  return channel.encoding == kTissueEncoding || channel.encoding == kTissueEffectsEncoding;
}

void PlayedTissue::begin() {
  surfaces_.clear();
  effects_ = {};
  clip_shapes_ = {};
  shown_effects_.reset();
  changed_ = true;
}

void PlayedTissue::take(const mcap::Channel& channel, std::span<const std::byte> message) {
  const auto head = read_tissue_head(message);
  Stream* stream = channel.encoding == kTissueEffectsEncoding ? &effects_ : nullptr;
  if (stream == nullptr && (surfaces_.contains(channel.topic) || surfaces_.size() < kMostChannels))
    stream = &surfaces_[channel.topic];
  if (!head || stream == nullptr) {
    ++refused_;
    return;
  }
  if (head->has_shape) stream->shape.assign(message.begin(), message.end());
  stream->newest.assign(message.begin(), message.end());
  changed_ = true;
}

void PlayedTissue::update(Surface& surface) {
  if (!surface.shape.empty()) {
    if (auto shape = read_shape(surface.shape)) {
      surface.known = *std::move(shape);
    } else {
      ++refused_;
    }
    surface.shape.clear();
  }
  if (surface.newest.empty()) return;
  if (auto made = read_surface(surface.newest, surface.known)) {
    surface.shown = std::make_shared<const TissueSurface>(*std::move(made));
  } else {
    ++refused_;
  }
  surface.newest.clear();
}

void PlayedTissue::update_effects() {
  if (!effects_.shape.empty()) {
    if (auto shapes = read_clip_shapes(effects_.shape)) {
      clip_shapes_ = *std::move(shapes);
    } else {
      ++refused_;
    }
    effects_.shape.clear();
  }
  if (effects_.newest.empty()) return;
  if (auto made = read_tissue_effects(effects_.newest, clip_shapes_)) {
    shown_effects_ = std::make_shared<const TissueView>(*std::move(made));
  } else {
    ++refused_;
  }
  effects_.newest.clear();
}

void PlayedTissue::publish() {
  if (!changed_) return;
  changed_ = false;
  auto view = std::make_shared<TissueView>();
  update_effects();
  if (shown_effects_) *view = *shown_effects_;
  if (rest_) {
    view->surfaces = rest_->surfaces;
    if (!shown_effects_) view->pool = rest_->pool;
  }
  for (auto& [topic, surface] : surfaces_) {
    update(surface);
    if (!surface.shown) continue;
    const auto of_cell = std::ranges::find(view->surfaces, surface.shown->name, &TissueSurface::name);
    if (of_cell == view->surfaces.end()) {
      view->surfaces.push_back(*surface.shown);
    } else {
      const std::shared_ptr<const MeshAppearance> look = of_cell->look;
      *of_cell = *surface.shown;
      of_cell->look = look;
    }
  }
  // Pictures are drawn again where it has changed: a seek may show the same step with other shapes.
  view->step = ++step_;
  const bool empty = view->surfaces.empty() && view->clips.empty() && view->particles.empty() && !view->pool.present;
  views_.publish(empty ? nullptr : std::move(view));
}

}  // namespace cellmirror::app
