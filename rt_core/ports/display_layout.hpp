// How the display is divided (manual 1.2.3: STDP, COVW): the array of views and the six displays that show them. Plain
// data; as it is made it is the manual's standard setting. A layout file (.lay) sets another one: docs/cell-files.md.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace cellmirror {

inline constexpr std::size_t kViews = 7;     // 0 to 6, manual 1.2.3, COVW
inline constexpr std::size_t kDisplays = 6;  // 1 to 6, manual 1.2.3, STDP

struct LayoutView {
  std::string name;  // in titles and at the page
  // From the cell to the viewer, in the world, of any length above 0: initial direction of the view.
  Eigen::Vector3d towards_viewer;
  bool orthogonal = false;
};

// A view in a part of the picture: 0 to 1 of it, from its upper left corner.
struct LayoutPane {
  int view = 0;  // 0 to 6
  double left = 0;
  double top = 0;
  double width = 1;
  double height = 1;
};

// Its panes do not overlap, show different views, and the first one is the main view: the one that FULL shows alone,
// and whose axes SCREEN_INC takes. There is at least one.
struct LayoutDisplay {
  std::string name;
  std::vector<LayoutPane> panes;
};

struct DisplayLayout {
  std::array<LayoutView, kViews> views{{{"perspective", {-0.5, -0.7, 0.4}, false},
                                        {"top", {0, 0, 1}, true},
                                        {"side", {0, -1, 0}, true},
                                        {"top", {0, 0, 1}, true},
                                        {"side", {0, -1, 0}, true},
                                        {"side in perspective", {0, -1, 0}, false},
                                        {"bird's eye", {-0.3, -0.4, 0.85}, false}}};
  // In "top and side" x is the same in both views.
  std::array<LayoutDisplay, kDisplays> displays{{{"perspective", {{.view = 0}}},
                                                 {"top and side",
                                                  {{.view = 1, .left = 0, .top = 0, .width = 1, .height = 0.5},
                                                   {.view = 2, .left = 0, .top = 0.5, .width = 1, .height = 0.5}}},
                                                 {"top", {{.view = 3}}},
                                                 {"side", {{.view = 4}}},
                                                 {"side in perspective", {{.view = 5}}},
                                                 {"bird's eye", {{.view = 6}}}}};
};

}  // namespace cellmirror
