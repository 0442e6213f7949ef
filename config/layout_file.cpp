#include "config/layout_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "config/table_reader.hpp"
#include "config/tables_file.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

constexpr Range kPart{0.0, 1.0};
constexpr Range kDirection{-1e6, 1e6};
constexpr double kShortestDirection = 1e-6;

bool is_control(char c) { return static_cast<unsigned char>(c) < ' ' || c == 0x7F; }

void read_name(TableReader& table, std::string& name) {
  const auto text = table.text("name");
  if (!text) return;
  if (text->empty() || text->size() > kLongestLayoutName || std::ranges::any_of(*text, is_control)) {
    table.error("name", fmt::format("\"{}\" cannot be a title", printable(*text)),
                fmt::format("a title has 1 to {} bytes, without control characters", kLongestLayoutName));
    return;
  }
  name = *text;
}

void read_view(TableReader& table, DisplayLayout& layout, std::vector<int>& before) {
  const auto id = read_new_id(table, 0, static_cast<int>(kViews) - 1, "view", before);
  LayoutView ignored = layout.views.front();
  LayoutView& view = id ? layout.views[static_cast<std::size_t>(*id)] : ignored;
  read_name(table, view.name);
  if (const auto from = table.vector3("seen_from", kDirection)) {
    view.towards_viewer = *from;
    if (from->norm() < kShortestDirection)
      table.error("seen_from", "seen_from has length zero", "e.g. seen_from = [0, 0, 1] looks down from above");
  }
  view.orthogonal =
      table.choice<bool>("projection", {{"perspective", false}, {"parallel", true}}).value_or(view.orthogonal);
  table.finish();
}

bool overlap(const LayoutPane& a, const LayoutPane& b) {
  return a.left + a.width > b.left + kPaneTolerance && b.left + b.width > a.left + kPaneTolerance &&
         a.top + a.height > b.top + kPaneTolerance && b.top + b.height > a.top + kPaneTolerance;
}

// True where the area is a good one.
bool read_area(TableReader& table, LayoutPane& pane) {
  const auto area = table.numbers("area", 4, kPart);
  if (!area) return !table.has("area");  // the whole picture
  pane.left = (*area)[0];
  pane.top = (*area)[1];
  pane.width = (*area)[2];
  pane.height = (*area)[3];
  if (pane.width < kSmallestPane || pane.height < kSmallestPane) {
    table.error("area", fmt::format("a pane of {:g} by {:g} is too small", pane.width, pane.height),
                fmt::format("width and height are fractions of the picture, at least {:g}", kSmallestPane));
    return false;
  }
  if (pane.left + pane.width > 1.0 + kPaneTolerance || pane.top + pane.height > 1.0 + kPaneTolerance) {
    table.error(
        "area",
        fmt::format("the pane ends at {:g} to the right and {:g} below, out of the picture", pane.left + pane.width,
                    pane.top + pane.height),
        "area = [left, top, width, height], in fractions of the picture: left + width and top + height are at most 1");
    return false;
  }
  return true;
}

struct ReadPane {
  std::size_t number = 0;  // counts from 1
  std::optional<int> view;
  std::optional<LayoutPane> area;
};

ReadPane read_pane(TableReader& table) {
  ReadPane pane;
  table.require("view");
  if (const auto view = table.integer("view", 0, static_cast<long long>(kViews) - 1))
    pane.view = static_cast<int>(*view);
  LayoutPane area;
  area.view = pane.view.value_or(0);
  if (read_area(table, area)) pane.area = area;
  table.finish();
  return pane;
}

void compare(const TableReader& table, const std::vector<ReadPane>& before, const ReadPane& pane) {
  for (const ReadPane& other : before) {
    if (pane.view && other.view == pane.view)
      table.error("view", fmt::format("view {} is in pane {} already", *pane.view, other.number));
    if (pane.area && other.area && overlap(*other.area, *pane.area))
      table.error("area", fmt::format("the pane overlaps pane {}", other.number));
  }
}

void read_display(TableReader& table, DisplayLayout& layout, std::vector<int>& before) {
  const auto id = read_new_id(table, 1, static_cast<int>(kDisplays), "display", before);
  LayoutDisplay ignored;
  LayoutDisplay& display = id ? layout.displays[static_cast<std::size_t>(*id - 1)] : ignored;
  read_name(table, display.name);
  const std::size_t errors = table.diagnostics().errors();
  std::vector<ReadPane> panes;
  for (TableReader& row : table.tables("pane", kViews)) {
    ReadPane pane = read_pane(row);
    pane.number = panes.size() + 1;
    compare(row, panes, pane);
    panes.push_back(pane);
  }
  if (table.has("pane")) {
    display.panes.clear();
    for (const ReadPane& pane : panes) display.panes.push_back(pane.area.value_or(LayoutPane{}));
    if (panes.empty() && table.diagnostics().errors() == errors)
      table.error("pane", "it has no panes", "omit the key for those of the standard setting");
  }
  table.finish();
}

}  // namespace

std::optional<DisplayLayout> parse_layout(std::string_view text, const std::string& file, Diagnostics& diagnostics) {
  return parse_tables<DisplayLayout>(text, file, diagnostics, [](TableReader& top, DisplayLayout& layout) {
    std::vector<int> views;
    for (TableReader& row : top.tables("view", kViews)) read_view(row, layout, views);
    std::vector<int> displays;
    for (TableReader& row : top.tables("display", kDisplays)) read_display(row, layout, displays);
    if (!top.has("view") && !top.has("display"))
      top.error({}, "it has no views and no displays", "docs/cell-files.md shows [[view]] and [[display]]");
  });
}

std::optional<DisplayLayout> read_layout(const std::filesystem::path& path, const std::string& shown,
                                         Diagnostics& diagnostics) {
  const auto text = text_of_file(path, kLargestLayoutFile, shown, diagnostics);
  return text ? parse_layout(*text, shown, diagnostics) : std::nullopt;
}

}  // namespace cellmirror
