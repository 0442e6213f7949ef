#include "app/owner/played_commands.hpp"

namespace cellmirror::app {

namespace {

using script::FormId;

bool shows_only(FormId command) {
  switch (command) {
    case FormId::comment:
    case FormId::load_views:
    case FormId::draw_scene:
    case FormId::swap_node:
    case FormId::level_down:
    case FormId::level_up:
    case FormId::set_frame_render:
    case FormId::set_abstract_render:
    case FormId::set_campar:
    case FormId::tag_drawlen:
    case FormId::cam_tracking:
    case FormId::cam_view_pyramid:
    case FormId::arc:
    case FormId::stdp:
    case FormId::stvw:
    case FormId::covw:
    case FormId::set_mode:
    case FormId::bfrm:
    case FormId::fldr:
    case FormId::shad:
    case FormId::wait:
    case FormId::set_force_arrow:
    case FormId::set_frc_arr_special:
    case FormId::vv_clip:
    case FormId::vv_clip_pos:
    case FormId::vv_set_lut:
    case FormId::vv_set_lut_par_medical:
    case FormId::vv_set_lut_par:
    case FormId::vv_reload_luts:
    case FormId::vv_iso:
    case FormId::set_collpar_active:
    case FormId::set_collpar_warning:
    case FormId::set_collpar_pair:
    case FormId::stop_script:
      return true;
    default:
      return false;
  }
}

// What the startup script says about the model and about what is sent.
bool sets_up(FormId command) {
  switch (command) {
    case FormId::activate:
    case FormId::deactivate:
    case FormId::delete_node:
    case FormId::robact:
    case FormId::exec_script:
    case FormId::connect:
    case FormId::frame_to_wfrm:
    case FormId::set_frame_placement:
    case FormId::robot_sending:
    case FormId::set_usspar_active:
    case FormId::set_usspar_sendmode:
    case FormId::set_usspar_range:
    case FormId::cam_online:
    case FormId::rob_por_def:
    case FormId::rob_tcp_def:
    case FormId::rob_jnt_max_range:
    case FormId::rob_jnt_min_range:
      return true;
    default:
      return false;
  }
}

}  // namespace

std::optional<Error> withheld_in_playback(FormId command, script::CommandSource::Kind from) {
  if (shows_only(command) || (from == script::CommandSource::Kind::file && sets_up(command))) return std::nullopt;
  return Error{"this is a replay: robots, devices and the cell are as they were recorded",
               "only commands that change views, pictures and collision tests are executed"};
}

}  // namespace cellmirror::app
