// Every example of the manual gives the values that the manual means, in SI. The expected numbers were worked out by
// hand from the text (1 degree = 0.017453292519943295 rad), not by the code under test.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/unit/scripts/test_text.hpp"

namespace cellmirror::script {
namespace {

struct Example {
  const char* text;
  FormId form;
  std::vector<std::string> words;  // the first slots, where they are names
  std::vector<double> numbers;     // the slots behind them
  const char* active = "MANTEC_RM3";
};

void PrintTo(const Example& example, std::ostream* out) { *out << example.text; }

constexpr double kDegree = 0.017453292519943295;

const Example kExamples[] = {
    {"ACTIVATE Testlab_1.FL_Klein.Flansch_Typ1", FormId::activate, {"Testlab_1.FL_Klein.Flansch_Typ1"}, {}},
    {"DEACTIVATE Testlab_1.FL_Klein.Flansch_Typ1", FormId::deactivate, {"Testlab_1.FL_Klein.Flansch_Typ1"}, {}},
    {"DELETE_NODE Testlab_1.FL_Klein.Flansch_Typ1", FormId::delete_node, {"Testlab_1.FL_Klein.Flansch_Typ1"}, {}},
    {"SWAP_NODE Testlab_1.FL_Klein.Flansch_Typ1", FormId::swap_node, {"Testlab_1.FL_Klein.Flansch_Typ1"}, {}},
    {"LEVEL_DOWN Testlab_1.FL_Klein", FormId::level_down, {"Testlab_1.FL_Klein"}, {}},
    {"LEVEL_UP Testlab_1.FL_Klein", FormId::level_up, {"Testlab_1.FL_Klein"}, {}},
    {"ROBOT_LANGUAGE jet_tarm", FormId::robot_language, {}, {3}},
    {"ROBACT PUMA_762", FormId::robact, {"PUMA_762"}, {}},
    {"TF_LOAD r3demo mantec_R3", FormId::tf_load, {"r3demo", "mantec_R3"}, {}},
    {"TF_RUN r3demo2 mantec_R3a", FormId::tf_run, {"r3demo2", "mantec_R3a"}, {}},
    {"TF_RUN hs2 ZELLENKRAN exec_wait", FormId::tf_run, {"hs2", "ZELLENKRAN"}, {0}},
    {"TF_DELETE ird_getschr MANTEC_RM3", FormId::tf_delete, {"ird_getschr", "MANTEC_RM3"}, {}},
    {"LOAD_VIEWS view1.vws", FormId::load_views, {"view1.vws"}, {}},
    {"EXEC_SCRIPT trs_demo.spt", FormId::exec_script, {"trs_demo.spt"}, {}},
    {"DRAW_SCENE", FormId::draw_scene, {}, {}},
    {"CONNECT\n\nTestlab_1.FL_Klein_02.Flansch_Typ1\n\nTO\n\nMantec_1.HAND ;",
     FormId::connect,
     {"Testlab_1.FL_Klein_02.Flansch_Typ1", "Mantec_1.HAND"},
     {}},
    {"FRAME_TO_WFRM Toolbox.Tool1 TO\n\nMantec_1.HAND Tool1_WFRM ;",
     FormId::frame_to_wfrm,
     {"Toolbox.Tool1", "Mantec_1.HAND", "Tool1_WFRM"},
     {}},
    {"POS_ROB MANTEC_RM3 JOINT_ABS 27.5 -17.38 -11.02 37.338 0.9 -12.271 ;",
     FormId::pos_rob_joint_abs,
     {"MANTEC_RM3"},
     {0.47996554429844063, -0.30333822399661446, -0.19233528356977512, 0.6516710361096428, 0.015707963267948967,
      -0.21416935251222416}},
    {"POS_ROB MANTEC_RM3 JOINT_INC -0.1 0 0 0.85 0 -0.3 ;",
     FormId::pos_rob_joint_inc,
     {"MANTEC_RM3"},
     {-0.0017453292519943296, 0, 0, 0.0148352986419518, 0, -0.005235987755982988}},
    {"POS_ROB MANTEC_RM3 FRAME_ABS 1000.0 0 0 -90.0 0 -90.0;",
     FormId::pos_rob_frame_abs,
     {"MANTEC_RM3"},
     {1.0, 0, 0, -1.5707963267948966, 0, -1.5707963267948966}},
    {"POS_ROB MANTEC_RM3 FRAME_INC X -0.1 Y 0.5 A -0.01;",
     FormId::pos_rob_frame_inc,
     {"MANTEC_RM3"},
     {-0.0001, 0.0005, 0, -0.00017453292519943296, 0, 0}},
    {"POS_ROB MANTEC_RM3 TOOL_INC Z 0.182 B 0.001 ;",
     FormId::pos_rob_tool_inc,
     {"MANTEC_RM3"},
     {0, 0, 0.000182, 0, 1.7453292519943296e-05, 0}},
    {"POS_ROB MANTEC_RM3 SCREEN_INC X 1, C 180",
     FormId::pos_rob_screen_inc,
     {"MANTEC_RM3"},
     {0.001, 0, 0, 0, 0, 3.141592653589793}},
    {"SET_FRAME Testlab_1.FL_Klein.Flansch_Typ1 RENDER 2 ;",
     FormId::set_frame_render,
     {"Testlab_1.FL_Klein.Flansch_Typ1"},
     {0}},
    {"SET_FRAME Testlab_1.FL_Klein.Flansch_Typ1 PLACEMENT\n-88.5 16.32851 -180.0 -11920.0 2517.3 912.7 ;",
     FormId::set_frame_placement,
     {"Testlab_1.FL_Klein.Flansch_Typ1"},
     {-1.5446163880149817, 16.32851 * kDegree, -3.141592653589793, -11.92, 2.5173, 0.9127}},
    {"SET_ABSTRACT Testlab_1.FL_Klein RENDER 20", FormId::set_abstract_render, {"Testlab_1.FL_Klein"}, {3}},
    {"ROBOT MANTEC_R3 online ;", FormId::robot_online, {"MANTEC_R3"}, {0}},
    {"ROBOT MANTEC_R3 offline ;", FormId::robot_online, {"MANTEC_R3"}, {1}},
    {"ROBOT MANTEC_R3 send_on ;", FormId::robot_sending, {"MANTEC_R3"}, {0}},
    {"ROBOT MANTEC_R3 send_off ;", FormId::robot_sending, {"MANTEC_R3"}, {1}},
    {"SET_CAMPAR CAMERA_5 4.85 15.71 ;", FormId::set_campar, {"CAMERA_5"}, {4.85, 0.27419122548830914}},
    {"SET_USSPAR active USS_1B 0 ;", FormId::set_usspar_active, {"USS_1B"}, {0}},
    {"SET_USSPAR sendmode 1 ;", FormId::set_usspar_sendmode, {}, {1}},
    {"SET_USSPAR range USS_5 3500.0 ;", FormId::set_usspar_range, {"USS_5"}, {3.5}},
    {"TAG_DRAWLEN 50.0 ;", FormId::tag_drawlen, {}, {0.05}},
    {"CAM_VIEW_PYRAMID UMG_Kamera_1 on ;", FormId::cam_view_pyramid, {"UMG_Kamera_1"}, {0}},
    {"CAM_ONLINE UMG_Kamera_1 off ;", FormId::cam_online, {"UMG_Kamera_1"}, {1}},
    {"rob_cart_lin_vel 1200.0;", FormId::rob_cart_lin_vel, {}, {1.2}},
    {"rob_cart_lin_acc 4800.0;", FormId::rob_cart_lin_acc, {}, {4.8}},
    {"rob_cart_rot_vel 360.0;", FormId::rob_cart_rot_vel, {}, {6.283185307179586}},
    {"rob_cart_rot_acc 720.0;", FormId::rob_cart_rot_acc, {}, {12.566370614359172}},
    {"rob_cart_vel_scal 0.3;", FormId::rob_cart_vel_scal, {}, {0.3}},
    {"rob_cart_acc_scal 0.65;", FormId::rob_cart_acc_scal, {}, {0.65}},
    {"rob_cart_fly_radius 0 0.4", FormId::rob_cart_fly_radius, {}, {0, 0.4}},
    {"rob_cart_fly_radius 1 5.0 ;", FormId::rob_cart_fly_radius, {}, {1, 0.005}},
    {"rob_cart_fly_radius 2 90", FormId::rob_cart_fly_radius, {}, {2, 1.5707963267948966}},
    {"rob_program_delays 0.25", FormId::rob_program_delays, {}, {0.25}},
    {"rob_jnt_max_range 162.5 110.0 145.0 187.5 115.5 270.0;",
     FormId::rob_jnt_max_range,
     {},
     {2.8361600344907854, 1.9198621771937625, 2.530727415391778, 3.2724923474893677, 2.0158552860534505,
      4.71238898038469}},
    {"rob_jnt_min_range -162.5 -110.0 -145.0 -187.5 -115.5 -270.0;",
     FormId::rob_jnt_min_range,
     {},
     {-2.8361600344907854, -1.9198621771937625, -2.530727415391778, -3.2724923474893677, -2.0158552860534505,
      -4.71238898038469}},
    {"rob_jnt_start_pos 0.0 50.0 -110.0 0.0 -150.0 -180.0;",
     FormId::rob_jnt_start_pos,
     {},
     {0, 0.8726646259971648, -1.9198621771937625, 0, -2.6179938779914944, -3.141592653589793}},
    {"rob_jnt_ref_pos 17.35 0 -12.79307 1.507E-03 0.0 15.2003;",
     FormId::rob_jnt_ref_pos,
     {},
     {17.35 * kDegree, 0, -12.79307 * kDegree, 0.001507 * kDegree, 0, 15.2003 * kDegree}},
    {"rob_jnt_max_vel 1.919862 1.483553 5.235988\n3.14159 4.014257 3.926991 ;",
     FormId::rob_jnt_max_vel,
     {},
     {1.919862, 1.483553, 5.235988, 3.14159, 4.014257, 3.926991}},
    {"rob_jnt_min_vel 8.5 3.14159E-04 4.014257E-04 ;",
     FormId::rob_jnt_min_vel,
     {},
     {0.0085, 0.000314159, 0.0004014257},
     "ZELLENKRAN"},
    {"rob_jnt_act_vel 1300.0 3.14159 1.5707963;", FormId::rob_jnt_act_vel, {}, {1.3, 3.14159, 1.5707963}, "ZELLENKRAN"},
    {"rob_jnt_max_acc 1000 2 3;", FormId::rob_jnt_max_acc, {}, {1.0, 2, 3}, "ZELLENKRAN"},
    {"rob_jnt_act_acc 1.919862 1.483553 5.235988\n3.14159 4.014257 3.926991 ;",
     FormId::rob_jnt_act_acc,
     {},
     {1.919862, 1.483553, 5.235988, 3.14159, 4.014257, 3.926991}},
    {"rob_PTPmode sync;", FormId::rob_ptp_mode, {}, {0}},
    {"rob_por_def 418.0 0.0 \xe2\x80\x93"
     "78.0 90.0 \xe2\x80\x93"
     "45.0 0.0",
     FormId::rob_por_def,
     {},
     {0.418, 0, -0.078, 1.5707963267948966, -0.7853981633974483, 0}},
    {"rob_tcp_def 83.0 -170.0 0.0 -90.0 0.0 -30.0",
     FormId::rob_tcp_def,
     {},
     {0.083, -0.17, 0, -1.5707963267948966, 0, -0.5235987755982988}},
    {"rob_vel_profile ramp;", FormId::rob_vel_profile, {}, {1}},
    {"rob_inverse_class align_POS ;", FormId::rob_inverse_class, {}, {1}},
    {"ARC on ;", FormId::arc, {}, {0}},
    {"STDP 1 FULL;", FormId::stdp, {}, {1, 0}},
    {"STDP 2", FormId::stdp, {}, {2}},
    {"STVW 0 VP 1238 1511 -662.28 VA 22.5 STEPS 35;",
     FormId::stvw,
     {},
     {0, 1.238, 1.511, -0.66228, 0, 0, 0, 0, 0.39269908169872414, 0, 0, 35, 0}},
    {"STVW 0 VP 519.7 -539 -850 LP 2183 9570 3391 TIME 15.0;",
     FormId::stvw,
     {},
     {0, 0.5197, -0.539, -0.85, 2.183, 9.57, 3.391, 0, 0, 0, 0, 0, 15}},
    {"SET_MODE GEO_VIS_TEST off", FormId::set_mode, {}, {9, 1}},
    {"BFRM on", FormId::bfrm, {}, {0}},
    {"FLDR off", FormId::fldr, {}, {1}},
    {"SHAD on", FormId::shad, {}, {0}},
    {"WAIT", FormId::wait, {}, {}},
    {"SET_FORCE_ARROW 4 0 1", FormId::set_force_arrow, {}, {4, 0, 1}},
    {"SET_TORQUE_LIMIT 0 1.5", FormId::set_torque_limit, {}, {0, 1.5}},
    {"SET_EXT_TCP_TEST on 1 2 3 0.25", FormId::set_ext_tcp_test, {}, {0, 1, 2, 3, 0.25}},
    {"SET_EXT_TCP_TEST off", FormId::set_ext_tcp_test, {}, {1}},
    {"SET_FRC_ARR_SPECIAL on", FormId::set_frc_arr_special, {}, {0}},
    {"eladyn_geo_def ALL 0x1f", FormId::eladyn_geo_def_flags, {"ALL"}, {31}},
    {"eladyn_geo_def liver.mpo 3 1 2 3 4.5", FormId::eladyn_geo_def_flags, {"liver.mpo"}, {3, 1, 2, 3, 4.5}},
    {"eladyn_geo_def liver.mpo VISIBLE off", FormId::eladyn_geo_def_token, {"liver.mpo"}, {10, 1}},
    {"eladyn_geo_def liver.mpo wet on", FormId::eladyn_geo_def_token, {"liver.mpo"}, {11, 0}},
    {"eladyn_geo_def jaw 1 5 1.5 7 8", FormId::eladyn_geo_def_cylinders, {"jaw"}, {1, 0.005, 0.0015, 0.007, 8}},
    {"eladyn_hyper_name links.hyp", FormId::eladyn_hyper_name, {"links.hyp"}, {}},
    {"eladyn_show_def 1", FormId::eladyn_show_def, {}, {1}},
    {"eladyn_model_reset", FormId::eladyn_model_reset, {}, {}},
    {"eladyn_plaus_param INSTRUMENT_SPEED 0x3f 500", FormId::eladyn_plaus_param, {}, {0, 63, 0.5}},
    {"eladyn_plaus_param PENETRATION 4 2.5", FormId::eladyn_plaus_param, {}, {1, 4, 0.0025}},
    {"eladyn_plaus_param CONTACT_FORCE 2 8.5", FormId::eladyn_plaus_param, {}, {2, 2, 8.5}},
    {"eladyn_plaus_param grip_force 8 6", FormId::eladyn_plaus_param, {}, {3, 8, 6}},
    {"eladyn_plaus_param NODE_SPEED 1 250", FormId::eladyn_plaus_param, {}, {4, 1, 0.25}},
    {"eladyn_plaus_param STRAIN 0 1.5", FormId::eladyn_plaus_param, {}, {5, 0, 1.5}},
    {"EFFECTS PULSE ON", FormId::effects_pulse, {}, {0}},
    {"EFFECTS BLEEDING OFF", FormId::effects_bleeding, {}, {1}},
    {"EFFECTS POOL_RIPPLES ON", FormId::effects_pool_ripples, {}, {0}},
    {"EFFECTS RESET_POOL", FormId::effects_reset_pool, {}, {}},
    {"EFFECTS CLEAN_ENDOSCOPIC_LENSE", FormId::effects_clean_endoscopic_lense, {}, {}},
    {"EFFECTS SUCTION ON", FormId::effects_suction, {}, {0}},
    {"EFFECTS irrigation off", FormId::effects_irrigation, {}, {1}},
    {"eladyn_calc off", FormId::eladyn_calc, {}, {1}},
    {"rob_ela_interact 1 1 100 0 2", FormId::rob_ela_interact, {}, {1, 1, 0.1, 0, 2}, "ZELLENKRAN"},
    {"rob_ela_interact 2 4 -180 90 4",
     FormId::rob_ela_interact,
     {},
     {2, 4, -3.141592653589793, 1.5707963267948966, 4},
     "ZELLENKRAN"},
    {"ela_clip_def clip.mpo 180 0 0 1 2 3",
     FormId::ela_clip_def,
     {"clip.mpo"},
     {3.141592653589793, 0, 0, 0.001, 0.002, 0.003}},
    {"rob_ela_shm 0 0x51d 64", FormId::rob_ela_shm, {}, {0, 1309, 64}},
    {"bin_ela_shm 1 2352 8", FormId::bin_ela_shm, {}, {1, 2352, 8}},
    {"BIN_ELA offline", FormId::bin_ela, {}, {1}},
    {"hot_message Gripper  closed, part 7", FormId::hot_message, {"Gripper  closed, part 7"}, {}},
    {"VV_CLIP CLP3", FormId::vv_clip, {}, {2}},
    {"VV_CLIP CLP3 visible", FormId::vv_clip, {}, {2, 2}},
    {"VV_CLIP_POS CLP2 DIST 1 ELE 0 AZI 0", FormId::vv_clip_pos, {}, {1, 0, 0, 0.001}},
    {"VV_CLIP_POS CLP1 ELE 90 AZI -90 DIST 12.5",
     FormId::vv_clip_pos,
     {},
     {0, 1.5707963267948966, -1.5707963267948966, 0.0125}},
    {"VV_SET_LUT RAINBOW_LUT", FormId::vv_set_lut, {}, {3}},
    {"VV_SET_LUT_PAR MEDICAL_LUT 0 0.25 0.5 1", FormId::vv_set_lut_par_medical, {}, {0, 0.25, 0.5, 1}},
    {"VV_SET_LUT_PAR EXP_LUT 3 20 2 1.57", FormId::vv_set_lut_par, {}, {1, 3, 20, 2, 1.57}},
    {"VV_RELOAD_LUTS", FormId::vv_reload_luts, {}, {}},
    {"VV_ISO on", FormId::vv_iso, {}, {0, 0}},
    {"VV_ISO off VALUE -12.5", FormId::vv_iso, {}, {1, -12.5}},
    {"SAVE_FLIGHT stop.csv", FormId::save_flight, {"stop.csv"}, {}},
    {"RECORD keep", FormId::record, {}, {2}},
    {"ALARM_ACK Ada 12", FormId::alarm_ack, {"Ada"}, {12}},
    {"ALARM_ACK Ada", FormId::alarm_ack, {"Ada"}, {}},
    {"rob_positioning jump", FormId::rob_positioning, {}, {1}},
    {"STOP_ROB MANTEC_RM3", FormId::stop_rob, {"MANTEC_RM3"}, {}},
    {"RESET_HAPTIC MANTEC_RM3", FormId::reset_haptic, {"MANTEC_RM3"}, {}},
    {"STOP_ALL", FormId::stop_all, {}, {}},
    {"STOP_SCRIPT 3", FormId::stop_script, {}, {3}},
    {"SET_COLLPAR active 0", FormId::set_collpar_active, {}, {0}},
    {"SET_COLLPAR warning 50.0", FormId::set_collpar_warning, {}, {0.05}},
    {"SET_COLLPAR pair Toolbox.Tool1 Mantec_1.HAND derive",
     FormId::set_collpar_pair,
     {"Toolbox.Tool1", "Mantec_1.HAND"},
     {2}},
    {"MOVE_ROB ZELLENKRAN PTP JOINT_ABS 100 180", FormId::move_rob_joint_abs, {"ZELLENKRAN"}, {0, 0.1, 180 * kDegree}},
    {"MOVE_ROB ZELLENKRAN lin joint_inc 100", FormId::move_rob_joint_inc, {"ZELLENKRAN"}, {1, 0.1}},
    {"MOVE_ROB MANTEC_RM3 PTP FRAME_ABS 1000.0 0 0 -90.0 0 -90.0",
     FormId::move_rob_frame_abs,
     {"MANTEC_RM3"},
     {0, 1.0, 0, 0, -1.5707963267948966, 0, -1.5707963267948966}},
    {"MOVE_ROB MANTEC_RM3 LIN FRAME_INC Z 10, A 90",
     FormId::move_rob_frame_inc,
     {"MANTEC_RM3"},
     {1, 0, 0, 0.01, 1.5707963267948966, 0, 0}},
    {"MOVE_ROB MANTEC_RM3 LIN TOOL_INC X 1", FormId::move_rob_tool_inc, {"MANTEC_RM3"}, {1, 0.001, 0, 0, 0, 0, 0}},
    {"MOVE_ROB MANTEC_RM3 LIN SCREEN_INC Y 1", FormId::move_rob_screen_inc, {"MANTEC_RM3"}, {1, 0, 0.001, 0, 0, 0, 0}},
    {"MOVE_ROB MANTEC_RM3 PTP START", FormId::move_rob_start, {"MANTEC_RM3"}, {0}},
    {"MOVE_ROB MANTEC_RM3 PTP REFERENCE", FormId::move_rob_reference, {"MANTEC_RM3"}, {0}},
    {"SAVE_VIEWS view1.vws", FormId::save_views, {"view1.vws"}, {}},
    {"TF_BACK boom_inspect PUMA_762", FormId::tf_back, {"boom_inspect", "PUMA_762"}, {}},
    {"TF_HOLD MANTEC_RM3", FormId::tf_hold, {"MANTEC_RM3"}, {}},
    {"TF_RESUME MANTEC_RM3", FormId::tf_resume, {"MANTEC_RM3"}, {}},
    {"TF_STEP MANTEC_RM3", FormId::tf_step, {"MANTEC_RM3"}, {}},
    {"TF_STEP MANTEC_RM3 BACKWARD", FormId::tf_step, {"MANTEC_RM3"}, {1}},
    {"TF_STOP MANTEC_RM3", FormId::tf_stop, {"MANTEC_RM3"}, {}},
    {"TF_WAIT MANTEC_RM3", FormId::tf_wait, {"MANTEC_RM3"}, {}},
    {"TF_RECORD taught PUMA_762 START", FormId::tf_record, {"taught", "PUMA_762"}, {0}},
    {"SET_INPUT MANTEC_RM3 3 on", FormId::set_input, {"MANTEC_RM3"}, {3, 0}},
    {"SET_ANALOG_INPUT MANTEC_RM3 1 4.75", FormId::set_analog_input, {"MANTEC_RM3"}, {1, 4.75}},
};

class ManualExample : public ::testing::TestWithParam<Example> {};

TEST_P(ManualExample, GivesItsValuesInSi) {
  const Example& example = GetParam();
  cellmirror::testing::FakeNames names;
  names.active = example.active;
  const Read sut(example.text, &names);
  ASSERT_TRUE(sut.fine);
  EXPECT_EQ(sut.command.id(), example.form);
  EXPECT_TRUE(sut.command.converted());
  ASSERT_EQ(sut.command.size(), example.words.size() + example.numbers.size());
  for (std::size_t i = 0; i < example.words.size(); ++i) EXPECT_EQ(sut.command.text(i), example.words[i]);
  for (std::size_t i = 0; i < example.numbers.size(); ++i)
    EXPECT_DOUBLE_EQ(sut.command.number(example.words.size() + i), example.numbers[i]) << "value " << i;
}

INSTANTIATE_TEST_SUITE_P(Commands, ManualExample, ::testing::ValuesIn(kExamples));

TEST(ManualExamples, CoverEveryFormButTheTwoWithSlotsOfBothKinds) {
  std::vector<bool> covered(kFormCount, false);
  for (const Example& example : kExamples) covered[static_cast<std::size_t>(example.form)] = true;
  std::size_t uncovered = 0;
  for (std::size_t i = 0; i < covered.size(); ++i) {
    if (!covered[i]) ++uncovered;
  }
  // Comment lines and the foot switches' files are no commands; CAM_TRACKING, COVW and MASTER_SLAVE stand below.
  EXPECT_EQ(uncovered, 5U);
}

TEST(ManualExamples, CameraTrackingHasATargetOnlyWithOn) {
  const cellmirror::testing::FakeNames names;
  const Read on("CAM_TRACKING UMG_Kamera_1 on Gantry.J_2.Hand ;", &names);
  EXPECT_EQ(on.command.text(0), "UMG_Kamera_1");
  EXPECT_EQ(on.command.choice(1), 0U);
  EXPECT_EQ(on.command.text(2), "Gantry.J_2.Hand");
  const Read off("CAM_TRACKING UMG_Kamera_1 off", &names);
  EXPECT_EQ(off.command.choice(1), 1U);
  EXPECT_FALSE(off.command.given(2));
}

TEST(ManualExamples, ViewIsConnectedToCamera) {
  const cellmirror::testing::FakeNames names;
  const Read sut("COVW 0 UMG_Kamera_1;", &names);
  EXPECT_EQ(sut.command.id(), FormId::covw);
  EXPECT_EQ(sut.command.integer(0), 0);
  EXPECT_EQ(sut.command.text(1), "UMG_Kamera_1");
}

TEST(ManualExamples, MasterSlaveListsItsSlavesAndPairs) {
  const cellmirror::testing::FakeNames names;
  const Read sut("MASTER_SLAVE on PUMA_762 2 MANTEC_RM3,2 J_1 J_4 J_2 J_5 ZELLENKRAN 1 J_3 J_1", &names);
  ASSERT_TRUE(sut.fine);
  EXPECT_EQ(sut.command.id(), FormId::master_slave);
  ASSERT_EQ(sut.command.size(), 13U);
  EXPECT_EQ(sut.command.text(3), "MANTEC_RM3");
  EXPECT_EQ(sut.command.integer(4), 2);
  EXPECT_EQ(sut.command.text(5), "J_1");
  EXPECT_EQ(sut.command.text(8), "J_5");
  EXPECT_EQ(sut.command.text(9), "ZELLENKRAN");
  EXPECT_EQ(sut.command.text(12), "J_1");
}

TEST(ManualExamples, LongestMasterSlaveFits) {
  cellmirror::testing::FakeNames names;
  for (const char* name : {"M", "S1", "S2", "S3", "S4", "S5"})
    names.robots[name] = std::vector<JointKind>(kMaxJointsPerRobot, JointKind::revolute);
  std::string text = "MASTER_SLAVE on M 5";
  for (int slave = 1; slave <= 5; ++slave) {
    text += " S" + std::to_string(slave) + " 16";
    for (int joint = 1; joint <= 16; ++joint) text += " J_1 J_" + std::to_string(joint);
  }
  const Read sut(text, &names);
  ASSERT_TRUE(sut.fine);
  EXPECT_EQ(sut.command.size(), kMaxValues);
}

TEST(ManualExamples, ViewGroupsComeInAnyOrderAndSayWhatWasGiven) {
  const Read sut("STVW 3 TIME 2 TW -90 VP 1 2 3", nullptr);
  EXPECT_TRUE(sut.command.given(1));   // VP
  EXPECT_FALSE(sut.command.given(2));  // LP
  EXPECT_TRUE(sut.command.given(3));   // TW
  EXPECT_FALSE(sut.command.given(7));  // STEPS
  EXPECT_TRUE(sut.command.given(8));   // TIME
  EXPECT_DOUBLE_EQ(sut.command.number(3), 0.003);
  EXPECT_DOUBLE_EQ(sut.command.number(7), -1.5707963267948966);
}

TEST(ManualExamples, JointListsStayUnconvertedWithoutDirectory) {
  const Read sut("rob_jnt_max_range 162.5 110.0", nullptr);
  EXPECT_FALSE(sut.command.converted());
  EXPECT_DOUBLE_EQ(sut.command.number(0), 162.5);
}

}  // namespace
}  // namespace cellmirror::script
