// Manual 1.2.1: the general commands that concern one robot, frame, camera or sensor.
#include "scripts/lang/slots.hpp"
#include "scripts/lang/table_parts.hpp"

namespace cellmirror::script {

namespace {

using namespace parts;

constexpr std::string_view kSection = "1.2.1";

constexpr Choice kRenderModes[] = {{"2", "wireframe"}, {"3", "flat"}, {"4", "Gouraud"}, {"20", "transparent"}};
constexpr Choice kSending[] = {{"send_on", "start"}, {"send_off", "stop"}};
constexpr Choice kSendModes[] = {{"0", "one message per sensor"}, {"1", "one message with all ranges"}};

constexpr Parameter kJointAbs[] = {robot(), word("JOINT_ABS"), some_joints("joint position")};
constexpr Parameter kJointInc[] = {robot(), word("JOINT_INC"), some_joints("joint increment")};
constexpr Parameter kFrameAbs[] = {robot(),
                                   word("FRAME_ABS"),
                                   number("x", "x", Unit::mm),
                                   number("y", "y", Unit::mm),
                                   number("z", "z", Unit::mm),
                                   number("r", "roll", Unit::degree),
                                   number("p", "pitch", Unit::degree),
                                   number("y", "yaw", Unit::degree)};

constexpr Parameter kX = optional_labelled("X", number("x", "increment along x", Unit::mm));
constexpr Parameter kY = optional_labelled("Y", number("y", "increment along y", Unit::mm));
constexpr Parameter kZ = optional_labelled("Z", number("z", "increment along z", Unit::mm));
constexpr Parameter kA = optional_labelled("A", number("r", "roll increment", Unit::degree));
constexpr Parameter kB = optional_labelled("B", number("p", "pitch increment", Unit::degree));
constexpr Parameter kC = optional_labelled("C", number("y", "yaw increment", Unit::degree));
constexpr Parameter kFrameInc[] = {robot(), word("FRAME_INC"), kX, kY, kZ, kA, kB, kC};
constexpr Parameter kToolInc[] = {robot(), word("TOOL_INC"), kX, kY, kZ, kA, kB, kC};
constexpr Parameter kScreenInc[] = {robot(), word("SCREEN_INC"), kX, kY, kZ, kA, kB, kC};

constexpr Parameter kRender[] = {frame(), word("RENDER"), choice("mode", "rendering mode", kRenderModes)};
constexpr Parameter kPlacement[] = {frame(),
                                    word("PLACEMENT"),
                                    number("wx", "rotation about x", Unit::degree),
                                    number("wy", "rotation about y", Unit::degree),
                                    number("wz", "rotation about z", Unit::degree),
                                    number("dx", "translation along x", Unit::mm),
                                    number("dy", "translation along y", Unit::mm),
                                    number("dz", "translation along z", Unit::mm)};
constexpr Parameter kRobotOnline[] = {robot(), choice("online | offline", "monitoring", kOnlineOffline)};
constexpr Parameter kRobotSending[] = {robot(), choice("send_on | send_off", "sending", kSending)};
constexpr Parameter kCameraParameters[] = {camera("CAM_id"),
                                           number("view_dist", "focal distance", Unit::metre, kPositive),
                                           number("fovy_angle", "opening angle", Unit::degree, kOpeningAngle)};
constexpr Parameter kSensorActive[] = {word("active"), named(NameKind::sensor, "USS_id", "sensor"),
                                       choice("0 | 1", "switch", kZeroOne)};
constexpr Parameter kSensorSendMode[] = {word("sendmode"), choice("0 | 1", "sending mode", kSendModes)};
constexpr Parameter kSensorRange[] = {word("range"), named(NameKind::sensor, "USS_id", "sensor"),
                                      number("USS_range", "range", Unit::mm, kPositive)};
constexpr Parameter kDrawLength[] = {number("len_value", "length", Unit::mm, kPositive)};
constexpr Parameter kTracking[] = {camera(), on_off("tracking"), optional(frame("frame_id", "target frame"))};
constexpr Parameter kCameraSwitch[] = {camera(), on_off()};

// docs/script.md, "Motion", says the rest.
constexpr std::string_view kJointNote =
    "a PTP move that replaces the running move; in a file the next command waits for its end. Joints without a value "
    "stay; too many values, or one beyond a limit: refused";
constexpr std::string_view kFrameAbsNote =
    "a PTP move to the nearest posture found for rob_inverse_class; out of reach: refused with the nearest pose";
constexpr std::string_view kFrameIncNote =
    "a linear move from the last commanded position; rotation about the TCP, in axes of the ZP frame. Groups in any "
    "order, each at most once, commas optional";
constexpr std::string_view kToolIncNote =
    "a linear move from the last commanded position, in axes of the TCP. Groups in any order, each at most once, "
    "commas optional";
constexpr std::string_view kScreenIncNote =
    "a linear move from the last commanded position; rotation about the TCP, in axes of the current view (the first of "
    "the display that STDP selects) at that moment, also in a sequence or at a camera. Groups in any order, each at "
    "most once, commas optional";

// The slots by which scripts/commands reads the values.
static_assert(has_slots(kRender, {slots::render::kFrame, slots::render::kMode}));
static_assert(has_slots(kPlacement,
                        {slots::placement::kFrame, slots::placement::kRotation, slots::placement::kTranslation}));
static_assert(has_slots(kRobotOnline, {slots::robot_online::kRobot, slots::robot_online::kOnline}));
static_assert(has_slots(kRobotSending, {slots::robot_sending::kRobot, slots::robot_sending::kSending}));
static_assert(has_slots(kCameraParameters,
                        {slots::campar::kCamera, slots::campar::kFocalDistance, slots::campar::kOpeningAngle}));
static_assert(has_slots(kSensorActive, {slots::sensor_active::kSensor, slots::sensor_active::kOn}));
static_assert(has_slots(kSensorRange, {slots::sensor_range::kSensor, slots::sensor_range::kRange}));
static_assert(has_slots(kTracking,
                        {slots::camera_switch::kCamera, slots::camera_switch::kOn, slots::camera_switch::kTarget}));
static_assert(has_slots(kCameraSwitch, {slots::camera_switch::kCamera, slots::camera_switch::kOn}));
static_assert(has_slots(kJointAbs, {slots::pos_rob::kRobot, {slots::pos_rob::kTarget, 2, "j1 ... jn"}}));
static_assert(has_slots(kFrameAbs, {slots::pos_rob::kRobot, {slots::pos_rob::kTarget, 2, "x"}}));
static_assert(has_slots(kFrameInc, {slots::pos_rob::kRobot, {slots::pos_rob::kTarget, 2, "X"}}));
static_assert(has_slots(kToolInc, {slots::pos_rob::kRobot, {slots::pos_rob::kTarget, 2, "X"}}));
static_assert(has_slots(kScreenInc, {slots::pos_rob::kRobot, {slots::pos_rob::kTarget, 2, "X"}}));

constexpr Form kForms[] = {
    {.id = FormId::pos_rob_joint_abs,
     .name = "POS_ROB",
     .syntax = "POS_ROB <Robot_id> JOINT_ABS <j1> ... <jn>",
     .section = kSection,
     .parameters = kJointAbs,
     .help = "moves a robot's joints to positions",
     .example = "POS_ROB MANTEC_RM3 JOINT_ABS 27.5 -17.38 -11.02 37.338 0.9 -12.271",
     .definition = kJointNote,
     .effect = LoopEffect::queued,
     .selector = Selector::by_second_word},
    {.id = FormId::pos_rob_joint_inc,
     .name = "POS_ROB",
     .syntax = "POS_ROB <Robot_id> JOINT_INC <j1> ... <jn>",
     .section = kSection,
     .parameters = kJointInc,
     .help = "moves a robot's joints by increments",
     .example = "POS_ROB MANTEC_RM3 JOINT_INC -0.1 0 0 0.85 0 -0.3",
     .definition = kJointNote,
     .effect = LoopEffect::queued,
     .selector = Selector::by_second_word},
    {.id = FormId::pos_rob_frame_abs,
     .name = "POS_ROB",
     .syntax = "POS_ROB <Robot_id> FRAME_ABS <x> <y> <z> <r> <p> <y>",
     .section = kSection,
     .parameters = kFrameAbs,
     .help = "moves a robot's TCP to a pose in its ZP frame",
     .example = "POS_ROB MANTEC_RM3 FRAME_ABS 1000.0 0 0 -90.0 0 -90.0",
     .definition = kFrameAbsNote,
     .effect = LoopEffect::queued,
     .selector = Selector::by_second_word},
    {.id = FormId::pos_rob_frame_inc,
     .name = "POS_ROB",
     .syntax = "POS_ROB <Robot_id> FRAME_INC [X x] [Y y] [Z z] [A r] [B p] [C y]",
     .section = kSection,
     .parameters = kFrameInc,
     .help = "moves a robot's TCP by an increment in its ZP frame",
     .example = "POS_ROB MANTEC_RM3 FRAME_INC X -0.1 Y 0.5 A -0.01",
     .definition = kFrameIncNote,
     .effect = LoopEffect::queued,
     .selector = Selector::by_second_word,
     .commas = true,
     .at_least_one = true},
    {.id = FormId::pos_rob_tool_inc,
     .name = "POS_ROB",
     .syntax = "POS_ROB <Robot_id> TOOL_INC [X x] [Y y] [Z z] [A r] [B p] [C y]",
     .section = kSection,
     .parameters = kToolInc,
     .help = "moves a robot's TCP by an increment in its TCP frame",
     .example = "POS_ROB MANTEC_RM3 TOOL_INC Z 0.182 B 0.001",
     .definition = kToolIncNote,
     .effect = LoopEffect::queued,
     .selector = Selector::by_second_word,
     .commas = true,
     .at_least_one = true},
    {.id = FormId::pos_rob_screen_inc,
     .name = "POS_ROB",
     .syntax = "POS_ROB <Robot_id> SCREEN_INC [X x] [Y y] [Z z] [A r] [B p] [C y]",
     .section = kSection,
     .parameters = kScreenInc,
     .help = "moves a robot's TCP by an increment in the space of the display: x right, y up, z out of it",
     .definition = kScreenIncNote,
     .effect = LoopEffect::queued,
     .selector = Selector::by_second_word,
     .commas = true,
     .at_least_one = true},
    {.id = FormId::set_frame_render,
     .name = "SET_FRAME",
     .syntax = "SET_FRAME <frame_node> RENDER <mode>",
     .section = kSection,
     .parameters = kRender,
     .help = "sets the rendering mode of a frame's geometry",
     .example = "SET_FRAME Testlab_1.FL_Klein.Flansch_Typ1 RENDER 2",
     .definition = "the last command for a geometry counts",
     .selector = Selector::by_second_word},
    {.id = FormId::set_frame_placement,
     .name = "SET_FRAME",
     .syntax = "SET_FRAME <frame_node> PLACEMENT <wx> <wy> <wz> <dx> <dy> <dz>",
     .section = kSection,
     .parameters = kPlacement,
     .help = "sets the pose of a frame in its predecessor; attached frames move along",
     .example = "SET_FRAME Testlab_1.FL_Klein.Flansch_Typ1 PLACEMENT -88.5 16.32851 -180.0 -11920.0 2517.3 912.7",
     .definition = "rotations first, about fixed axes: x, then y, then z",
     .effect = LoopEffect::queued,
     .selector = Selector::by_second_word},
    {.id = FormId::set_abstract_render,
     .name = "SET_ABSTRACT",
     .syntax = "SET_ABSTRACT <frame_node> RENDER <mode>",
     .section = kSection,
     .parameters = kRender,
     .help = "sets the rendering mode of a frame and of all detail levels below it",
     .definition = "for everything below the frame in the tree of names, loaded now or later"},
    {.id = FormId::robot_online,
     .name = "ROBOT",
     .syntax = "ROBOT <Robot_id> [online | offline]",
     .section = kSection,
     .parameters = kRobotOnline,
     .help = "opens or closes the channel to the real controller that drives the model",
     .example = "ROBOT MANTEC_R3 online",
     .effect = LoopEffect::queued,
     .selector = Selector::by_second_word},
    {.id = FormId::robot_sending,
     .name = "ROBOT",
     .syntax = "ROBOT <Robot_id> [send_on | send_off]",
     .section = kSection,
     .parameters = kRobotSending,
     .help = "starts or stops robot-parameter messages on the SENSOR channel (key 1990, type 5)",
     .example = "ROBOT MANTEC_R3 send_off",
     .effect = LoopEffect::queued,
     .selector = Selector::by_second_word},
    {.id = FormId::set_campar,
     .name = "SET_CAMPAR",
     .syntax = "SET_CAMPAR <CAM_id> <view_dist> <fovy_angle>",
     .section = kSection,
     .parameters = kCameraParameters,
     .help = "sets focal distance and opening angle of a camera's viewing pyramid",
     .example = "SET_CAMPAR CAMERA_5 4.85 15.71"},
    {.id = FormId::set_usspar_active,
     .name = "SET_USSPAR",
     .syntax = "SET_USSPAR active <USS_id> [0 | 1]",
     .section = kSection,
     .parameters = kSensorActive,
     .help = "switches the simulation of an ultrasonic sensor on or off",
     .example = "SET_USSPAR active USS_1B 0",
     .definition = "a sensor has the name of its workframe; if that is not unique, its dotted path",
     .effect = LoopEffect::queued,
     .selector = Selector::by_first_word},
    {.id = FormId::set_usspar_sendmode,
     .name = "SET_USSPAR",
     .syntax = "SET_USSPAR sendmode [0 | 1]",
     .section = kSection,
     .parameters = kSensorSendMode,
     .help = "sends one message per sensor (0, the default), or one with all ranges (1)",
     .example = "SET_USSPAR sendmode 1",
     .definition = "of active sensors only; docs/messages.md has the messages",
     .effect = LoopEffect::queued,
     .selector = Selector::by_first_word},
    {.id = FormId::set_usspar_range,
     .name = "SET_USSPAR",
     .syntax = "SET_USSPAR range <USS_id> <USS_range>",
     .section = kSection,
     .parameters = kSensorRange,
     .help = "sets the range within which a sensor detects obstacles",
     .example = "SET_USSPAR range USS_5 3500.0",
     .definition = "from the apex of the cone",
     .effect = LoopEffect::queued,
     .selector = Selector::by_first_word},
    {.id = FormId::tag_drawlen,
     .name = "TAG_DRAWLEN",
     .syntax = "TAG_DRAWLEN <len_value>",
     .section = kSection,
     .parameters = kDrawLength,
     .help = "sets the length at which the axes of workframes are drawn; 250 mm by default",
     .example = "TAG_DRAWLEN 50.0"},
    {.id = FormId::cam_tracking,
     .name = "CAM_TRACKING",
     .syntax = "CAM_TRACKING <cam_id> [on | off] (<frame_id>)",
     .section = kSection,
     .parameters = kTracking,
     .help = "makes a camera track a frame; the frame is given only with on",
     .example = "CAM_TRACKING UMG_Kamera_1 on Gantry.J_2.Hand",
     .definition = "the camera rotates about its own position, pan about the y axis of its workframe, then tilt about "
                   "its new x axis; twist is kept"},
    {.id = FormId::cam_view_pyramid,
     .name = "CAM_VIEW_PYRAMID",
     .syntax = "CAM_VIEW_PYRAMID <cam_id> [on | off]",
     .section = kSection,
     .parameters = kCameraSwitch,
     .help = "shows or hides a camera's viewing pyramid",
     .example = "CAM_VIEW_PYRAMID UMG_Kamera_1 on"},
    {.id = FormId::cam_online,
     .name = "CAM_ONLINE",
     .syntax = "CAM_ONLINE <cam_id> [on | off]",
     .section = kSection,
     .parameters = kCameraSwitch,
     .help = "starts or stops sending a camera's parameters to the camera-control process",
     .example = "CAM_ONLINE UMG_Kamera_1 on",
     .definition = "on the SENSOR channel (key 1990, type 5); docs/messages.md has the message"},
};

}  // namespace

std::span<const Form> device_forms() { return kForms; }

}  // namespace cellmirror::script
