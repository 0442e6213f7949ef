// What SCRIPT says of picture, views and cameras, as everybody sees it.
#include "app/owner/display/display_service.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <numbers>

#include "rt_core/base/log.hpp"
#include "rt_core/scene/panes.hpp"
#include "tests/unit/cell/cell_from_text.hpp"

namespace cellmirror::app {
namespace {

namespace fs = std::filesystem;

constexpr Nanoseconds kSecond{1'000'000'000};

class ActiveRobot final : public NameDirectory {
 public:
  std::string active;

  [[nodiscard]] bool knows(NameKind /*kind*/, std::string_view /*name*/) const override { return false; }
  [[nodiscard]] Error explain(NameKind /*kind*/, std::string_view /*name*/) const override { return {}; }
  [[nodiscard]] std::span<const JointKind> joints(std::string_view /*robot*/) const override { return {}; }
  [[nodiscard]] std::vector<std::string> joint_names(std::string_view /*robot*/) const override { return {}; }
  [[nodiscard]] std::string_view active_robot() const override { return active; }
  [[nodiscard]] std::vector<std::string> all(NameKind /*kind*/) const override { return {}; }
};

class DisplayDeskTest : public ::testing::Test {
 protected:
  void SetUp() override {
    set_log_level(LogLevel::error);
    folder_ = fs::temp_directory_path() / ("cellmirror_desk_" + std::to_string(::getpid()));
    fs::create_directories(folder_ / "scripts");
    auto home = KismetHome::open(folder_);
    ASSERT_TRUE(home);
    home_.emplace(*std::move(home));
    auto files = std::make_shared<TextFiles>();
    files->add("arm.mpc", kArm);
    files->add("eye.mpc", "[[node]]\nname = \"EYE\"\ntype = \"camera\"\n");
    Diagnostics diagnostics;
    cell_ = build_cell(
        "[[node]]\nname = \"Arm\"\nabstract = \"arm.mpc\"\n"
        "[[node]]\nname = \"Lab\"\ngeometry = [{ name = \"a\", sphere_m = 1.0 }]\n"
        "[[node]]\nname = \"Table\"\nparent = \"Lab\"\n[[node]]\nname = \"Part\"\nparent = \"Table\"\n"
        // Looks along the world's x from 4 m behind the origin; its picture's x is the world's -y.
        "[[node]]\nname = \"CAM\"\ntype = \"camera\"\nxyz_m = [-4, 0, 0]\n"
        "rpy_rad = [-1.5707963267948966, 0, -1.5707963267948966]\n"
        "[[node]]\nname = \"Left\"\nabstract = \"eye.mpc\"\n[[node]]\nname = \"Right\"\nabstract = \"eye.mpc\"\n",
        files, diagnostics);
    ASSERT_TRUE(cell_) << diagnostics.text();
    q_ = cell_->start_positions();
    sut_.emplace(DisplayService::Parts{*cell_, names_, *home_, clock_,
                                       [this] { return std::span<const JointValues>(q_); }, [this] { return updates_; },
                                       [this] { ++rings_; }, [this](std::size_t) { return robot_online_; }},
                 settings_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  template <typename T>
  std::string refusal(const Result<T>& result) {
    return result ? "done" : result.error().text();
  }
  const DisplayView& view(int id) {
    state_ = sut_->state();
    return state_->views[static_cast<std::size_t>(id)];
  }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / "scripts" / name, std::ios::binary) << text;
  }
  const CameraSetting& camera(const std::string& name) {
    state_ = sut_->state();
    const auto at = std::ranges::find(state_->cameras, name, &CameraSetting::name);
    EXPECT_NE(at, state_->cameras.end()) << name;
    return *at;
  }

  fs::path folder_;
  std::optional<KismetHome> home_;
  std::optional<Cell> cell_;
  std::vector<JointValues> q_;
  ActiveRobot names_;
  std::vector<ViewSetting> settings_;
  ManualClock clock_;
  std::uint64_t updates_ = 100;
  int rings_ = 0;
  bool robot_online_ = false;
  std::shared_ptr<const DisplayState> state_;
  std::optional<DisplayService> sut_;
};

ViewChange looking_from(const Eigen::Vector3d& viewpoint) {
  ViewChange change;
  change.viewpoint = viewpoint;
  change.lookpoint = Eigen::Vector3d::Zero();
  return change;
}

TEST_F(DisplayDeskTest, BeginsWithTheDocumentedModesAndViewsOfTheWholeCell) {
  const auto state = sut_->state();
  for (const DisplayMode on : {DisplayMode::floor, DisplayMode::shadows, DisplayMode::textures,
                               DisplayMode::antialiasing, DisplayMode::visibility_test})
    EXPECT_TRUE(state->on(on));
  EXPECT_EQ(state->modes.count(), 5U);
  EXPECT_TRUE(state->legend);
  EXPECT_EQ(state->display, 1);
  EXPECT_EQ(state->tag_length_m, 0.25);
  ASSERT_EQ(state->cameras.size(), 3U);
  EXPECT_EQ(state->cameras[0].name, "CAM");
  EXPECT_EQ(state->cameras[1].name, "Left.EYE");
}

TEST_F(DisplayDeskTest, TheStateIsTheSameObjectUntilSomethingChanges) {
  const auto before = sut_->state();
  sut_->follow();
  EXPECT_EQ(sut_->state(), before);
  ASSERT_TRUE(sut_->set_tag_length(0.1));
  const auto after = sut_->state();
  EXPECT_NE(after, before);
  EXPECT_GT(after->revision, before->revision);
  EXPECT_EQ(before->tag_length_m, 0.25);
}

TEST_F(DisplayDeskTest, ASequenceByTimeKeepsWaitUntilItsEnd) {
  ASSERT_TRUE(sut_->set_view(0, looking_from({0, -2, 0}), AtOnce{}));
  EXPECT_FALSE(sut_->busy());
  ASSERT_TRUE(sut_->set_view(0, looking_from({0, -4, 0}), InTime{2 * kSecond}));
  EXPECT_TRUE(sut_->busy());
  EXPECT_EQ(view(0).view.viewpoint.y(), -4);
  ASSERT_TRUE(view(0).sequence);
  EXPECT_EQ(view(0).sequence->from.viewpoint.y(), -2);
  clock_.advance(kSecond);
  sut_->follow();
  EXPECT_TRUE(sut_->busy());
  clock_.advance(kSecond);
  EXPECT_FALSE(sut_->busy());
  sut_->follow();
  EXPECT_FALSE(view(0).sequence);
}

TEST_F(DisplayDeskTest, ASequenceByStepsGoesByThePicturesUpdatesAlone) {
  ASSERT_TRUE(sut_->set_view(3, looking_from({0, 0, 9}), InSteps{10}));
  clock_.advance(100 * kSecond);
  updates_ = 109;
  EXPECT_TRUE(sut_->busy());
  updates_ = 110;
  EXPECT_FALSE(sut_->busy());
}

TEST_F(DisplayDeskTest, AViewOnItsWayGoesOnFromWhereItIs) {
  ASSERT_TRUE(sut_->set_view(0, looking_from({0, -2, 0}), AtOnce{}));
  ASSERT_TRUE(sut_->set_view(0, looking_from({0, -4, 0}), InTime{2 * kSecond}));
  clock_.advance(kSecond);
  ViewChange twist;
  twist.twist = 0.5;
  ASSERT_TRUE(sut_->set_view(0, twist, InTime{kSecond}));
  EXPECT_NEAR(view(0).sequence->from.viewpoint.y(), -3, 1e-9);
  EXPECT_NEAR(view(0).view.viewpoint.y(), -3, 1e-9);
}

TEST_F(DisplayDeskTest, RefusesViewsThatShowNothingAndKeepsTheOld) {
  const View before = view(2).view;
  EXPECT_FALSE(sut_->set_view(2, looking_from({0, 0, 0}), AtOnce{}));
  EXPECT_FALSE(sut_->set_view(7, looking_from({0, 0, 1}), AtOnce{}));
  EXPECT_FALSE(sut_->set_view(-1, looking_from({0, 0, 1}), InSteps{3}));
  EXPECT_EQ(view(2).view.viewpoint, before.viewpoint);
  EXPECT_FALSE(sut_->set_display(0, false));
  EXPECT_FALSE(sut_->set_display(7, false));
}

TEST_F(DisplayDeskTest, AViewFollowsItsCameraUntilStvwTakesItBack) {
  ASSERT_TRUE(sut_->connect_view(0, "CAM"));
  EXPECT_EQ(view(0).camera, "CAM");
  EXPECT_EQ(state_->current_camera, "CAM");
  // The screen's x is the camera's, its z points back at the camera.
  const Eigen::Matrix3d R_WS = sut_->screen_axes();
  EXPECT_LT((R_WS.col(0) - Eigen::Vector3d(0, -1, 0)).norm(), 1e-9) << R_WS;
  EXPECT_LT((R_WS.col(2) - Eigen::Vector3d(-1, 0, 0)).norm(), 1e-9) << R_WS;
  ViewChange zoom;
  zoom.opening_angle = 0.2;
  ASSERT_TRUE(sut_->set_view(0, zoom, AtOnce{}));
  EXPECT_EQ(view(0).camera, "");
  EXPECT_LT((view(0).view.viewpoint - Eigen::Vector3d(-4, 0, 0)).norm(), 1e-9);
}

TEST_F(DisplayDeskTest, AViewThatLeavesItsCameraProjectsAndClipsAsBefore) {
  const View before = view(1).view;
  ASSERT_TRUE(before.orthogonal);
  ASSERT_TRUE(sut_->connect_view(1, "CAM"));
  ASSERT_TRUE(sut_->set_view(1, looking_from({0, -4, 0}), AtOnce{}));
  EXPECT_TRUE(view(1).view.orthogonal);
  EXPECT_EQ(view(1).view.near_distance, before.near_distance);
  EXPECT_EQ(view(1).view.far_distance, before.far_distance);
}

TEST_F(DisplayDeskTest, ClippingPlanesAloneLeaveAViewAtItsCamera) {
  ASSERT_TRUE(sut_->connect_view(0, "CAM"));
  ViewChange planes;
  planes.near_distance = 1.5;
  planes.far_distance = 2.5;
  ASSERT_TRUE(sut_->set_view(0, planes, AtOnce{}));
  EXPECT_EQ(view(0).camera, "CAM");
  CellPoses poses;
  const auto cell = cell_->compile();
  compute_poses(*cell, q_, poses);
  const View shown = scene::view_now({*cell, poses, *sut_->state(), clock_.now(), updates_}, 0);
  EXPECT_EQ(shown.near_distance, 1.5);
  EXPECT_EQ(shown.far_distance, 2.5);
  planes.near_distance = 3.0;
  EXPECT_NE(refusal(sut_->set_view(0, planes, AtOnce{})).find("is not in front of the back one"), std::string::npos);
  EXPECT_EQ(view(0).view.near_distance, 1.5);
  EXPECT_EQ(view(0).camera, "CAM");
  ASSERT_TRUE(sut_->connect_view(0, "CAM"));
  EXPECT_LT(scene::view_now({*cell, poses, *sut_->state(), clock_.now(), updates_}, 0).near_distance, 0.1);
}

TEST_F(DisplayDeskTest, TheScreensAxesGoAlongWithASequence) {
  ViewChange upright = looking_from({0, -5, 0});
  upright.twist = 0.0;
  ASSERT_TRUE(sut_->set_view(0, upright, AtOnce{}));
  ViewChange turned;
  turned.twist = std::numbers::pi / 2;
  ASSERT_TRUE(sut_->set_view(0, turned, InTime{2 * kSecond}));
  clock_.advance(kSecond);
  const Eigen::Vector3d x = sut_->screen_axes().col(0);
  EXPECT_LT((x - Eigen::Vector3d(std::sqrt(0.5), 0, std::sqrt(0.5))).norm(), 1e-9) << x;
}

TEST_F(DisplayDeskTest, NamesACameraByItsPathWhereOthersHaveItsName) {
  EXPECT_NE(refusal(sut_->connect_view(0, "EYE")), "done");
  ASSERT_TRUE(sut_->connect_view(1, "Right.EYE"));
  EXPECT_EQ(view(1).camera, "Right.EYE");
  EXPECT_NE(refusal(sut_->connect_view(0, "NONE")), "done");
  EXPECT_NE(refusal(sut_->connect_view(0, "Table")), "done");
}

TEST_F(DisplayDeskTest, LetsGoOfCamerasFramesAndRobotsThatAreGone) {
  ASSERT_TRUE(sut_->connect_view(0, "Left.EYE"));
  ASSERT_TRUE(sut_->track("CAM", "Arm.TIP"));
  EXPECT_EQ(camera("CAM").tracks, "Arm.LIFT.TURN.BEND.TIP");
  names_.active = "ARM";
  ASSERT_TRUE(sut_->set_arc(true));
  EXPECT_EQ(sut_->state()->arcs, std::vector<std::string>{"ARM"});
  ASSERT_TRUE(cell_->delete_node("Left"));
  ASSERT_TRUE(cell_->delete_node("Arm"));
  sut_->follow();
  EXPECT_EQ(view(0).camera, "");
  EXPECT_EQ(camera("CAM").tracks, "");
  EXPECT_EQ(camera("EYE").name, "EYE");  // the only one of that name now
  EXPECT_TRUE(sut_->state()->arcs.empty());
}

TEST_F(DisplayDeskTest, ACameraKeepsWhatWasSetWhenItsNameInTheStateChanges) {
  ASSERT_TRUE(cell_->delete_node("Right"));
  ASSERT_TRUE(sut_->show_pyramid("EYE", true));
  ASSERT_TRUE(sut_->set_camera_online("EYE", true));
  ASSERT_TRUE(sut_->track("EYE", "Part"));
  ASSERT_TRUE(sut_->connect_view(1, "EYE"));
  const auto expect_all_of = [this](const std::string& name) {
    sut_->follow();
    EXPECT_TRUE(camera(name).pyramid);
    EXPECT_TRUE(camera(name).online);
    EXPECT_EQ(camera(name).tracks, "Lab.Table.Part");
    EXPECT_EQ(view(1).camera, name);
    EXPECT_EQ(sut_->state()->current_camera, name);
  };
  expect_all_of("EYE");
  ASSERT_TRUE(cell_->activate("Right"));  // a second of that name
  expect_all_of("Left.EYE");
  EXPECT_FALSE(camera("Right.EYE").online);
  ASSERT_TRUE(cell_->delete_node("Right"));
  expect_all_of("EYE");
}

TEST_F(DisplayDeskTest, SwitchesWhatConcernsOneCamera) {
  ASSERT_TRUE(sut_->show_pyramid("CAM", true));
  ASSERT_TRUE(sut_->set_camera_online("Left.EYE", true));
  ASSERT_TRUE(sut_->track("CAM", "Part"));
  EXPECT_TRUE(camera("CAM").pyramid);
  EXPECT_FALSE(camera("CAM").online);
  EXPECT_TRUE(camera("Left.EYE").online);
  EXPECT_EQ(camera("CAM").tracks, "Lab.Table.Part");
  ASSERT_TRUE(sut_->track("CAM", std::nullopt));
  EXPECT_EQ(camera("CAM").tracks, "");
  EXPECT_FALSE(sut_->track("CAM", "CAM"));
  EXPECT_FALSE(sut_->track("CAM", "Nobody"));
  EXPECT_FALSE(sut_->show_pyramid("Nobody", true));
  ASSERT_TRUE(sut_->set_camera("CAM", 4.85, 0.25));
  EXPECT_EQ(cell_->compile()->cameras[0].fovy_rad, 0.25);
}

TEST_F(DisplayDeskTest, ACameraCannotTrackWhatLiesInItsOwnAxis) {
  ASSERT_TRUE(cell_->connect("Left", "Arm.BEND", q_));
  ASSERT_TRUE(cell_->set_placement("Left", Pose::Identity()));
  EXPECT_NE(refusal(sut_->track("Left.EYE", "Left")).find("lies where the camera Left.EYE is"), std::string::npos);
  EXPECT_NE(refusal(sut_->track("Left.EYE", "Arm.BEND")).find("lies where the camera Left.EYE is"), std::string::npos);
  EXPECT_EQ(camera("Left.EYE").tracks, "");
  EXPECT_TRUE(sut_->track("Left.EYE", "Arm.TURN"));
  EXPECT_TRUE(camera("Left.EYE").tracking);
}

TEST_F(DisplayDeskTest, TheStateTellsWhetherATargetIsSomewhereToLookAt) {
  ASSERT_TRUE(sut_->track("Left.EYE", "Part"));  // both at the origin, but either may go
  EXPECT_EQ(camera("Left.EYE").tracks, "Lab.Table.Part");
  EXPECT_FALSE(camera("Left.EYE").tracking);
  Pose aside = Pose::Identity();
  aside.translation().x() = 1.0;
  ASSERT_TRUE(cell_->set_placement("Part", aside));
  sut_->follow();
  EXPECT_TRUE(camera("Left.EYE").tracking);
  ASSERT_TRUE(cell_->set_placement("Part", Pose::Identity()));
  sut_->follow();
  EXPECT_FALSE(camera("Left.EYE").tracking);
}

TEST_F(DisplayDeskTest, ShadowsNeedTheFloorAndTheCamerasViewACamera) {
  ASSERT_TRUE(sut_->set_mode(DisplayMode::shadows, false));
  ASSERT_TRUE(sut_->set_mode(DisplayMode::floor, false));
  EXPECT_NE(refusal(sut_->set_mode(DisplayMode::shadows, true)).find("FLDR on"), std::string::npos);
  ASSERT_TRUE(sut_->set_mode(DisplayMode::floor, true));
  EXPECT_TRUE(sut_->set_mode(DisplayMode::shadows, true));
  EXPECT_TRUE(sut_->set_mode(DisplayMode::camera_main_view, true));
  for (const char* node : {"CAM", "Left", "Right"}) ASSERT_TRUE(cell_->delete_node(node)) << node;
  sut_->follow();
  EXPECT_FALSE(sut_->state()->on(DisplayMode::camera_main_view));
  EXPECT_FALSE(sut_->set_mode(DisplayMode::camera_main_view, true));
}

TEST_F(DisplayDeskTest, WhoMissedThatSmearWasOffCanTell) {
  const std::uint64_t before = sut_->state()->smear_ends;
  ASSERT_TRUE(sut_->set_mode(DisplayMode::smear, true));
  EXPECT_EQ(sut_->state()->smear_ends, before);
  ASSERT_TRUE(sut_->set_mode(DisplayMode::smear, false));
  ASSERT_TRUE(sut_->set_mode(DisplayMode::smear, true));
  EXPECT_EQ(sut_->state()->smear_ends, before + 1);
}

TEST_F(DisplayDeskTest, OfDrawModesTheLastCounts) {
  ASSERT_TRUE(sut_->set_draw_mode("Part", false, DrawMode::wireframe));
  ASSERT_TRUE(sut_->set_draw_mode("Lab", false, DrawMode::flat));
  ASSERT_TRUE(sut_->set_draw_mode("Table", true, DrawMode::transparent));
  auto rules = sut_->state()->draw_rules;
  ASSERT_EQ(rules.size(), 2U);  // Part is covered by Table's branch
  EXPECT_EQ(rules[0].path, "Lab");
  EXPECT_EQ(rules[1].path, "Lab.Table");
  ASSERT_TRUE(sut_->set_draw_mode("Part", false, DrawMode::gouraud));
  ASSERT_TRUE(sut_->set_draw_mode("Part", false, DrawMode::wireframe));
  rules = sut_->state()->draw_rules;
  ASSERT_EQ(rules.size(), 3U);
  EXPECT_EQ(rules.back().mode, DrawMode::wireframe);
  EXPECT_FALSE(sut_->set_draw_mode("Nobody", true, DrawMode::flat));
}

TEST_F(DisplayDeskTest, RemarksWhereADrawModeShowsNothing) {
  EXPECT_EQ(*sut_->set_draw_mode("Table", false, DrawMode::wireframe),
            "Table has no geometry of its own; SET_ABSTRACT reaches what is below it");
  EXPECT_EQ(*sut_->set_draw_mode("Lab", false, DrawMode::wireframe), "");
  EXPECT_EQ(*sut_->set_draw_mode("Table", true, DrawMode::wireframe), "");
}

TEST_F(DisplayDeskTest, LimitsOfLengthsAreToldInTheUnitOfTheCommand) {
  EXPECT_NE(refusal(sut_->set_tag_length(1e6)).find("1000000000 mm, at most with 10000000 mm"), std::string::npos);
}

TEST_F(DisplayDeskTest, MessagesAreShownForFiveSecondsAndRingWhereBeepIsOn) {
  ASSERT_TRUE(sut_->show_message("quiet"));
  EXPECT_EQ(rings_, 0);
  ASSERT_TRUE(sut_->set_mode(DisplayMode::bell, true));
  clock_.advance(2 * kSecond);
  ASSERT_TRUE(sut_->show_message("loud"));
  EXPECT_EQ(rings_, 1);
  auto messages = sut_->state()->messages;
  ASSERT_EQ(messages.size(), 2U);
  EXPECT_FALSE(messages[0].bell);
  EXPECT_TRUE(messages[1].bell);
  EXPECT_EQ(messages[1].number, 2U);
  clock_.advance(3 * kSecond);
  sut_->follow();
  ASSERT_EQ(sut_->state()->messages.size(), 1U);
  EXPECT_EQ(sut_->state()->messages[0].text, "loud");
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(sut_->show_message("many"));
  EXPECT_EQ(sut_->state()->messages.size(), DisplayService::kKeptMessages);
}

TEST_F(DisplayDeskTest, ArcIsOfTheActiveRobot) {
  EXPECT_NE(refusal(sut_->set_arc(true)).find("ROBACT"), std::string::npos);
  names_.active = "ARM";
  ASSERT_TRUE(sut_->set_arc(true));
  ASSERT_TRUE(sut_->set_arc(true));
  EXPECT_EQ(sut_->state()->arcs.size(), 1U);
  ASSERT_TRUE(sut_->set_arc(false));
  EXPECT_TRUE(sut_->state()->arcs.empty());
}

TEST_F(DisplayDeskTest, LoadsWhatItHasSaved) {
  ASSERT_TRUE(sut_->set_view(0, looking_from({1, 2, 3}), AtOnce{}));
  ASSERT_TRUE(sut_->connect_view(6, "Left.EYE"));
  ASSERT_TRUE(sut_->set_display(6, true));
  const auto saved = sut_->state();
  ASSERT_TRUE(sut_->save_views("mine")) << refusal(sut_->save_views("mine"));
  EXPECT_TRUE(fs::exists(folder_ / "scripts" / "mine.vws"));
  ASSERT_TRUE(sut_->set_view(0, looking_from({9, 9, 9}), InTime{kSecond}));
  ASSERT_TRUE(sut_->set_view(6, looking_from({9, 9, 9}), AtOnce{}));
  ASSERT_TRUE(sut_->set_display(1, false));
  ASSERT_TRUE(sut_->load_views("mine")) << refusal(sut_->load_views("mine"));
  const auto loaded = sut_->state();
  for (std::size_t id = 0; id < kViews; ++id)
    EXPECT_EQ(loaded->views[id].view.viewpoint, saved->views[id].view.viewpoint) << id;
  EXPECT_EQ(loaded->views[6].camera, "Left.EYE");
  EXPECT_FALSE(loaded->views[0].sequence);
  EXPECT_EQ(loaded->display, 6);
  EXPECT_TRUE(loaded->full_screen);
}

TEST_F(DisplayDeskTest, AViewFileWithAnyErrorSetsNothing) {
  const auto before = sut_->state();
  write("odd.vws", "format = 1\n[[view]]\nid = 0\ntwist_rad = 1.0\n[[view]]\nid = 1\nopening_angle_rad = 9\n");
  EXPECT_NE(refusal(sut_->load_views("odd")).find("odd.vws:7:21"), std::string::npos)
      << refusal(sut_->load_views("odd"));
  write("camera.vws", "format = 1\n[[view]]\nid = 0\ntwist_rad = 1.0\n[[view]]\nid = 1\ncamera = \"CAN\"\n");
  EXPECT_NE(refusal(sut_->load_views("camera")).find("CAM"), std::string::npos) << refusal(sut_->load_views("camera"));
  write("clip.vws", "format = 1\n[[view]]\nid = 0\nnear_m = 1e6\n");
  EXPECT_NE(refusal(sut_->load_views("clip")), "done");
  EXPECT_NE(refusal(sut_->load_views("missing")), "done");
  EXPECT_NE(refusal(sut_->load_views("clap")).find("scripts/clap.vws does not exist"), std::string::npos);
  EXPECT_NE(refusal(sut_->load_views("clap")).find("did you mean clip?"), std::string::npos);
  write("startup.spt", "DRAW_SCENE;");
  EXPECT_TRUE(refusal(sut_->load_views("startup.spt")).starts_with("startup.spt is no view file (.vws): "));
  EXPECT_NE(refusal(sut_->load_views("../outside")), "done");
  EXPECT_EQ(sut_->state(), before);
}

TEST_F(DisplayDeskTest, SavesViewFilesAndNothingElse) {
  write("startup.spt", "DRAW_SCENE");
  for (const char* name : {"startup.spt", "../a.vws", "/tmp/a.vws", "a/b.vws", "..", ".vws"})
    EXPECT_NE(refusal(sut_->save_views(name)), "done") << name;
  std::ifstream in(folder_ / "scripts" / "startup.spt");
  std::string text;
  std::getline(in, text);
  EXPECT_EQ(text, "DRAW_SCENE");
}

TEST(FirstDisplay, TakesTheCellFilesViewsAndLeavesOutWhatDoesNotFit) {
  set_log_level(LogLevel::error);
  ViewSetting good;
  good.id = 3;
  good.change.twist = 0.75;
  ViewSetting bad;
  bad.id = 4;
  bad.change.near_distance = 1e9;
  ViewSetting unknown;
  unknown.id = 9;
  const std::vector<ViewSetting> settings = {good, bad, unknown};
  const DisplayState sut = initial_display(CompiledCell{}, Extent{}, settings);
  EXPECT_EQ(sut.views[3].view.twist, 0.75);
  EXPECT_LT(sut.views[4].view.near_distance, 1e3);
  EXPECT_TRUE(sut.cameras.empty());
}

TEST(FirstDisplay, HasItsViewsWhereTheLayoutHasThem) {
  DisplayLayout layout;
  layout.views[3].towards_viewer = {1, 0, 0};
  layout.displays[4].name = "gate";
  ViewSetting setting;
  setting.id = 4;
  setting.change.viewpoint = Eigen::Vector3d(7, 8, 9);
  const DisplayState sut = initial_display(CompiledCell{}, Extent{}, std::span(&setting, 1), layout);
  EXPECT_GT(sut.views[3].view.viewpoint.x(), 1);
  EXPECT_TRUE(sut.views[3].view.orthogonal);
  EXPECT_EQ(sut.views[4].view.viewpoint, Eigen::Vector3d(7, 8, 9)) << "the cell file says more than the layout";
  EXPECT_EQ(sut.layout.displays[4].name, "gate");
}

}  // namespace
}  // namespace cellmirror::app
