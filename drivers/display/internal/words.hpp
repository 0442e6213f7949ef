// All text of a picture: labels of the scene, names of frames, titles, legend, messages; and the borders of panes.
// Private to this folder; no OpenGL.
#pragma once

#include <span>

#include "drivers/display/internal/frame.hpp"
#include "drivers/display/internal/picture_text.hpp"

namespace cellmirror::display {

class Words {
 public:
  // Those that belong to a pane. Labels do not overlap: they move aside, and if there is no room the less important
  // ones (farther away, without mark) are left out.
  void draw_pane(const Frame& frame, Image& picture);
  void draw_title(const Pane& pane, int width, int height, Image& picture);
  void draw_legend(const Scene& scene, Image& picture);
  void draw_messages(const Scene& scene, Image& picture);

 private:
  struct Wanted {
    const std::string* text = nullptr;
    TextStyle look = TextStyle::plain;
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
    double distance = 0;
  };

  void want(const Frame& frame, const Eigen::Vector3d& at, const std::string& text, TextStyle look);
  void place(const PixelRect& within, const Wanted& label, Image& picture);

  TextPress press_;
  std::vector<Wanted> wanted_;
  std::vector<PixelRect> taken_;
};

// A line around each of several panes.
void draw_borders(std::span<const Pane> panes, Image& picture);

}  // namespace cellmirror::display
