#include "app/plot/figure.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include "app/plot/panel.hpp"

namespace cellmirror::plot {

Result<std::string> png_of(const Figure& figure) {
  if (figure.panels.empty() || figure.columns == 0) return fail("the plot has no panel");
  constexpr int kSmallest = 120;
  if (figure.panel_width < kSmallest || figure.panel_height < kSmallest) return fail("the plot's panels are too small");
  const std::size_t columns = std::min(figure.columns, figure.panels.size());
  const std::size_t rows = (figure.panels.size() + columns - 1) / columns;
  const double header = figure.title.empty() ? 8.0 : 84.0;
  const double width = static_cast<double>(columns) * figure.panel_width;
  const double height = header + static_cast<double>(rows) * figure.panel_height;
  if (width * height > kMostPixels || width > 32'000 || height > 32'000)
    return fail("the plot would be too large", "draw fewer panels");
  Canvas canvas(static_cast<int>(width), static_cast<int>(height), kBackground);
  constexpr double kMargin = 28;
  canvas.text(kMargin, 38, figure.title, 23, kInk, Anchor::left, true);
  canvas.text(kMargin, 64, figure.subtitle, 15, kFaintInk);
  // Panels below each other often share their x axis: they begin and end at the same place.
  std::vector<Sides> sides(columns);
  for (std::size_t i = 0; i < figure.panels.size(); ++i) {
    const Sides needed = sides_of(canvas, figure.panels[i]);
    Sides& of_column = sides[i % columns];
    of_column = {std::max(of_column.left, needed.left), std::max(of_column.right, needed.right)};
  }
  for (std::size_t i = 0; i < figure.panels.size(); ++i) {
    const std::size_t row = i / columns;
    const double x = static_cast<double>(i % columns) * figure.panel_width;
    const double y = header + static_cast<double>(row) * figure.panel_height;
    draw_panel(canvas, {x, y, static_cast<double>(figure.panel_width), static_cast<double>(figure.panel_height)},
               sides[i % columns], figure.panels[i]);
  }
  return canvas.png();
}

Result<void> write_png(const Figure& figure, const std::string& path) {
  const auto png = png_of(figure);
  if (!png) return std::unexpected(png.error());
  const auto cannot = [&path] {
    return fail("the plot " + path + " cannot be written: " + std::strerror(errno), "name a file in a folder of yours");
  };
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return fail("the plot " + path + " is a folder", "name a file");
  // A device (/dev/null) is written as it is; a file is made beside and then takes the place of the old one.
  const bool replace = !std::filesystem::exists(path, error) || std::filesystem::is_regular_file(path, error);
  const std::string beside = replace ? path + ".part" : path;
  {
    errno = 0;
    std::ofstream out(beside, std::ios::binary | std::ios::trunc);
    if (!out.write(png->data(), static_cast<std::streamsize>(png->size())).flush()) return cannot();
  }
  if (!replace) return {};
  std::filesystem::rename(beside, path, error);
  if (!error) return {};
  errno = error.value();
  return cannot();
}

}  // namespace cellmirror::plot
