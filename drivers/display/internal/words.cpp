#include "drivers/display/internal/words.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror::display {

namespace {

constexpr std::size_t kMostConsidered = 4000;
constexpr std::size_t kMostPlaced = 160;  // in a pane: more is a wall of text

TextStyle look_of(Mark mark) {
  switch (mark) {
    case Mark::near:
      return TextStyle::near;
    case Mark::touching:
      return TextStyle::touching;
    case Mark::ghost:
      return TextStyle::ghost;
    case Mark::none:
      break;
  }
  return TextStyle::plain;
}

int importance(TextStyle look) {
  if (look == TextStyle::touching) return 0;
  if (look == TextStyle::near) return 1;
  return look == TextStyle::ghost ? 2 : 3;
}

bool overlap(const PixelRect& a, const PixelRect& b) {
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

}  // namespace

void Words::want(const Frame& frame, const Eigen::Vector3d& at, const std::string& text, TextStyle look) {
  if (text.empty() || wanted_.size() >= kMostConsidered || !at.allFinite()) return;
  const Eigen::Vector4d clip = frame.view.clip(at);
  if (!clip.allFinite() || !(clip.w() > 0) || std::abs(clip.x()) > clip.w() || std::abs(clip.y()) > clip.w() ||
      std::abs(clip.z()) > clip.w())
    return;
  wanted_.push_back({&text, look, frame.view.pixel(clip), frame.view.distance(at)});
}

void Words::place(const PixelRect& within, const Wanted& label, Image& picture) {
  struct Offset {
    double across, down;  // of the text's own size, from its middle above the point
  };
  static constexpr std::array<Offset, 8> kOffsets = {Offset{0, 0}, {0.55, 0.6},   {-0.55, 0.6}, {0, 1.5},
                                                     {0.55, -0.7}, {-0.55, -0.7}, {0, -1.1},    {0, 2.6}};
  const Sticker& sticker = press_.label(*label.text, label.look);
  for (const Offset& offset : kOffsets) {
    PixelRect rect{static_cast<int>(std::lround(label.pixel.x() + (offset.across - 0.5) * sticker.width)),
                   static_cast<int>(std::lround(label.pixel.y() + (offset.down - 1) * sticker.height)) - 4,
                   sticker.width, sticker.height};
    rect.x = std::clamp(rect.x, within.x, std::max(within.x, within.x + within.width - rect.width));
    rect.y = std::clamp(rect.y, within.y, std::max(within.y, within.y + within.height - rect.height));
    if (std::any_of(taken_.begin(), taken_.end(), [&](const PixelRect& other) { return overlap(rect, other); }))
      continue;
    taken_.push_back(rect);
    return stick(picture, within, sticker, rect.x, rect.y);
  }
}

void Words::draw_pane(const Frame& frame, Image& picture) {
  wanted_.clear();
  taken_.clear();
  for (const SceneLabel& label : frame.scene.labels) {
    if (!frame.own(label.camera)) want(frame, label.at, label.text, look_of(label.mark));
  }
  for (const SceneAxes& axes : frame.scene.axes) want(frame, axes.X_WF.translation(), axes.name, TextStyle::plain);
  std::stable_sort(wanted_.begin(), wanted_.end(), [](const Wanted& a, const Wanted& b) {
    return std::pair(importance(a.look), a.distance) < std::pair(importance(b.look), b.distance);
  });
  for (const Wanted& label : wanted_) {
    if (taken_.size() >= kMostPlaced) break;
    place(frame.view.pixels(), label, picture);
  }
}

void Words::draw_title(const Pane& pane, int width, int height, Image& picture) {
  const std::optional<PixelRect> rect = pixels_of(pane, width, height);
  if (!rect || pane.title.empty()) return;
  stick(picture, *rect, press_.label(pane.title, TextStyle::title), rect->x + 8, rect->y + 6);
}

void Words::draw_legend(const Scene& scene, Image& picture) {
  if (scene.legend.empty()) return;
  const PixelRect all{0, 0, picture.width, picture.height};
  const Sticker& sticker = press_.legend(scene.legend);
  // It must not cover half of a small picture.
  if (2 * sticker.width > picture.width || 2 * sticker.height > picture.height) return;
  constexpr int kGap = 12;
  stick(picture, all, sticker, kGap, picture.height - sticker.height - kGap);
}

void Words::draw_messages(const Scene& scene, Image& picture) {
  constexpr std::size_t kMostMessages = 6;
  constexpr int kGap = 6;
  const PixelRect all{0, 0, picture.width, picture.height};
  constexpr int kMargin = 4;
  int top = std::min(28, picture.height / 10);
  std::vector<const std::string*> shown;  // the newest first: older ones go where there is no room for all
  int room = picture.height - top;
  for (std::size_t i = scene.messages.size(); i > 0 && shown.size() < kMostMessages; --i) {
    const std::string& text = scene.messages[i - 1];
    if (text.empty()) continue;
    room -= press_.message(text, picture.width - 2 * kMargin).height + kGap;
    if (room < 0 && !shown.empty()) break;
    shown.push_back(&text);
  }
  for (auto text = shown.rbegin(); text != shown.rend(); ++text) {
    const Sticker& sticker = press_.message(**text, picture.width - 2 * kMargin);
    stick(picture, all, sticker, std::max(kMargin, (picture.width - sticker.width) / 2), top);
    top += sticker.height + kGap;
  }
}

void draw_borders(std::span<const Pane> panes, Image& picture) {
  if (panes.size() < 2) return;
  constexpr std::array<std::uint8_t, 3> kColour = {128, 136, 150};
  const auto dot = [&](int x, int y) {
    const auto at =
        4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(x));
    std::copy(kColour.begin(), kColour.end(), picture.rgba.begin() + static_cast<std::ptrdiff_t>(at));
  };
  for (const Pane& pane : panes) {
    const std::optional<PixelRect> rect = pixels_of(pane, picture.width, picture.height);
    if (!rect) continue;
    const int right = rect->x + rect->width - 1;
    const int bottom = rect->y + rect->height - 1;
    for (int x = rect->x; x <= right; ++x) {
      if (rect->y > 0) dot(x, rect->y);
      if (bottom + 1 < picture.height) dot(x, bottom);
    }
    for (int y = rect->y; y <= bottom; ++y) {
      if (rect->x > 0) dot(rect->x, y);
      if (right + 1 < picture.width) dot(right, y);
    }
  }
}

}  // namespace cellmirror::display
