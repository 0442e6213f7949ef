#include "app/owner/display/display_service.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "rt_core/base/log.hpp"
#include "rt_core/base/units.hpp"
#include "rt_core/scene/panes.hpp"

namespace cellmirror::app {

namespace {

std::size_t bit_of(DisplayMode mode) { return static_cast<std::size_t>(mode); }

bool is_below(std::string_view path, std::string_view branch) {
  return path.starts_with(branch) && (path.size() == branch.size() || path[branch.size()] == '.');
}

bool names_planes_alone(const ViewChange& change) {
  return !change.viewpoint && !change.lookpoint && !change.twist && !change.opening_angle;
}

}  // namespace

DisplayModes initial_modes() {
  DisplayModes modes;
  for (const DisplayMode mode : {DisplayMode::floor, DisplayMode::shadows, DisplayMode::textures,
                                 DisplayMode::antialiasing, DisplayMode::visibility_test})
    modes.set(bit_of(mode));
  return modes;
}

DisplayState initial_display(const CompiledCell& cell, const Extent& extent, std::span<const ViewSetting> settings,
                             DisplayLayout layout) {
  DisplayState display;
  display.revision = 1;
  display.modes = initial_modes();
  display.layout = std::move(layout);
  const auto views = views_of_extent(extent, display.layout);
  for (std::size_t id = 0; id < kViews; ++id) display.views[id].view = views[id];
  for (const ViewSetting& setting : settings) {
    const auto known = check_view_id(setting.id);
    const View view =
        known ? changed_by(display.views[static_cast<std::size_t>(setting.id)].view, setting.change) : View{};
    const auto checked = known ? check_view(setting.id, view) : known;
    if (checked) {
      display.views[static_cast<std::size_t>(setting.id)].view = view;
    } else {
      log_warning("cell", "[[view]] {}: {}", setting.id, checked.error().text());
    }
  }
  for (const CompiledCamera& camera : cell.cameras) display.cameras.emplace_back().name = camera.name;
  return display;
}

DisplayService::DisplayService(Parts parts, std::span<const ViewSetting> settings, DisplayLayout layout)
    : parts_(std::move(parts)) {
  const auto cell = parts_.cell.compile();
  state_ = initial_display(*cell, extent_of(*cell, parts_.cell.start_positions()), settings, std::move(layout));
  follow_cell();
}

void DisplayService::changed() { shared_ = nullptr; }

std::shared_ptr<const DisplayState> DisplayService::state() {
  if (shared_ == nullptr) {
    ++state_.revision;
    shared_ = std::make_shared<const DisplayState>(state_);
  }
  return shared_;
}

std::uint64_t DisplayService::updates() const {
  if (parts_.picture_updates) return parts_.picture_updates();
  return static_cast<std::uint64_t>(std::max(0.0, seconds(parts_.clock.now() - Timestamp{}) * kNominalRate));
}

bool DisplayService::has_ended(const ViewSequence& sequence) const {
  return scene::ended(sequence, parts_.clock.now(), updates());
}

void DisplayService::follow() {
  follow_cell();
  follow_carriers();
  follow_targets();
  for (DisplayView& shown : state_.views) {
    if (!shown.sequence || !has_ended(*shown.sequence)) continue;
    shown.sequence.reset();
    changed();
  }
  const Timestamp now = parts_.clock.now();
  if (std::erase_if(state_.messages, [&](const ShownText& text) { return now - text.time >= kMessageTime; }) > 0)
    changed();
}

bool DisplayService::busy() const {
  return std::ranges::any_of(state_.views,
                             [&](const DisplayView& shown) { return shown.sequence && !has_ended(*shown.sequence); });
}

View DisplayService::view_now(int id) {
  const auto cell = parts_.cell.compile();
  compute_poses(*cell, parts_.positions(), poses_);
  return scene::view_now({*cell, poses_, state_, parts_.clock.now(), updates()}, id);
}

Eigen::Matrix3d DisplayService::screen_axes() {
  const auto cell = parts_.cell.compile();
  compute_poses(*cell, parts_.positions(), poses_);
  const auto panes = scene::panes_of_display({*cell, poses_, state_, parts_.clock.now(), updates()});
  return panes.front().eye.X_WE.linear();
}

Result<void> DisplayService::set_display(int display, bool full_screen) {
  if (display < 1 || display > static_cast<int>(kDisplays))
    return fail(fmt::format("there is no display {}", display), "STDP takes 1 to 6");
  state_.display = display;
  state_.full_screen = full_screen;
  changed();
  return {};
}

Result<void> DisplayService::set_view(int id, const ViewChange& change, const ViewPace& pace) {
  if (auto known = check_view_id(id); !known) return known;
  if (!view(id).camera.empty() && names_planes_alone(change)) return set_planes_at_camera(id, change);
  ViewSequence sequence;
  sequence.from = view_now(id);
  if (!view(id).camera.empty()) {
    // It goes on from where the camera is, but how it projects and clips is the view's own.
    const View& own = view(id).view;
    sequence.from.orthogonal = own.orthogonal;
    sequence.from.near_distance = own.near_distance;
    sequence.from.far_distance = own.far_distance;
  }
  sequence.to = changed_by(sequence.from, change);
  if (auto checked = check_view(id, sequence.to); !checked) return checked;
  if (const auto* steps = std::get_if<InSteps>(&pace)) {
    sequence.steps = steps->updates;
    sequence.first_step = updates();
  }
  if (const auto* time = std::get_if<InTime>(&pace)) {
    sequence.duration = time->time;
    sequence.begin = parts_.clock.now();
  }
  const bool at_once = sequence.steps == 0 && sequence.duration <= Nanoseconds(0);
  view(id).view = sequence.to;
  view(id).camera.clear();
  view(id).front_plane_set = false;
  view(id).sequence.reset();
  if (!at_once) view(id).sequence = sequence;
  changed();
  return {};
}

Result<void> DisplayService::set_mode(DisplayMode mode, bool on) {
  if (on && mode == DisplayMode::shadows && !state_.on(DisplayMode::floor))
    return fail("shadows need the floor, which is off", "switch it on first with FLDR on");
  if (on && mode == DisplayMode::camera_main_view && parts_.cell.compile()->cameras.empty())
    return fail("the cell has no camera that could fill the display", "a cell or component file adds one");
  state_.modes.set(bit_of(mode), on);
  if (mode == DisplayMode::smear && !on) ++state_.smear_ends;
  changed();
  return {};
}

Result<void> DisplayService::set_legend(bool on) {
  state_.legend = on;
  changed();
  return {};
}

// Older rules that the new one covers wholly are forgotten, so that there are never more than nodes.
Result<std::string> DisplayService::set_draw_mode(std::string_view node, bool branch, DrawMode mode) {
  const auto found = parts_.cell.find(node);
  if (!found) return std::unexpected(found.error());
  DrawRule rule{parts_.cell.path(*found), branch, mode};
  std::erase_if(state_.draw_rules, [&](const DrawRule& old) {
    return branch ? is_below(old.path, rule.path) : !old.branch && old.path == rule.path;
  });
  state_.draw_rules.push_back(std::move(rule));
  changed();
  if (branch || has_own_geometry(*found)) return std::string();
  return fmt::format("{} has no geometry of its own; SET_ABSTRACT reaches what is below it", node);
}

bool DisplayService::has_own_geometry(NodeId node) const {
  if (!parts_.cell.node(node).definition->geometry.empty()) return true;
  const auto cell = parts_.cell.compile();
  const std::string path = parts_.cell.path(node);
  return std::ranges::any_of(cell->geometry, [&](const CompiledGeometry& part) {
    return (*cell->paths)[static_cast<std::size_t>(part.node)] == path;
  });
}

Result<void> DisplayService::set_tag_length(double length_m) {
  if (length_m > kFarthestView) {
    return fail(fmt::format("workframes cannot be drawn with a length of {:.10g} mm, at most with {:.10g} mm",
                            mm_from_m(length_m), mm_from_m(kFarthestView)));
  }
  if (!(length_m > 0.0))
    return fail(fmt::format("workframes cannot be drawn with a length of {:g} mm", mm_from_m(length_m)));
  state_.tag_length_m = length_m;
  changed();
  return {};
}

Result<void> DisplayService::set_arc(bool on) {
  const std::string robot(parts_.names.active_robot());
  if (robot.empty()) return fail("no robot is active", "activate one with ROBACT <robot>");
  std::erase(state_.arcs, robot);
  if (on) state_.arcs.push_back(robot);
  changed();
  return {};
}

Result<void> DisplayService::show_message(std::string_view text) {
  const bool bell = state_.on(DisplayMode::bell);
  state_.messages.push_back({std::string(text), parts_.clock.now(), ++messages_shown_, bell});
  if (parts_.message_shown) parts_.message_shown(state_.messages.back());
  if (state_.messages.size() > kKeptMessages) state_.messages.erase(state_.messages.begin());
  changed();
  log_warning("hot_message", "{}", text);
  if (bell && parts_.bell) parts_.bell();
  return {};
}

}  // namespace cellmirror::app
