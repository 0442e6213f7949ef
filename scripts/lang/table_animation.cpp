// Manual 1.2.3: commands for animation.
#include "rt_core/ports/words.hpp"
#include "scripts/lang/slots.hpp"
#include "scripts/lang/table_parts.hpp"

namespace cellmirror::script {

namespace {

using namespace parts;

constexpr std::string_view kSection = "1.2.3";

constexpr Range kViewIds{0, 6};
constexpr Range kSequenceTime{0, 86400};  // a day

constexpr Choice kFull[] = {{"FULL", "full screen"}, {"FULL_OFF", "normal"}};
// In the order of DisplayMode, then ours.
constexpr Choice kModes[] = {
    {cellmirror::word(DisplayMode::workframes), "workframes drawn"},
    {cellmirror::word(DisplayMode::smear), "trace of the active robot's TCP, with TCP_DRAW also of its orientation"},
    {cellmirror::word(DisplayMode::backface_removal), "backface removal by the graphics system"},
    {cellmirror::word(DisplayMode::cpu_backface_removal), "backface removal by the CPU"},
    {cellmirror::word(DisplayMode::camera_main_view), "camera view in the main display area"},
    {cellmirror::word(DisplayMode::two_sided_light), "lighting of both sides"},
    {cellmirror::word(DisplayMode::tcp_frame), "TCP frame of the active robot"},
    {cellmirror::word(DisplayMode::zero_point_frame), "ZP frame of the active robot"},
    {cellmirror::word(DisplayMode::floor), "floor"},
    {cellmirror::word(DisplayMode::visibility_test), "visibility test of geometries"},
    {cellmirror::word(DisplayMode::shadows), "shadows; needs the floor"},
    {cellmirror::word(DisplayMode::bell), "a bell with messages, at the terminal of the gateway and at the page"},
    {cellmirror::word(DisplayMode::textures), "textures and colours of meshes, and the tiles of the floor"},
    {cellmirror::word(DisplayMode::antialiasing), "antialiasing"},
    {"LEGEND", "legend of marks and colours; ours"},
};

constexpr Parameter kDisplay[] = {integer("display_id", "display", {1, 6}),
                                  optional(choice("FULL | FULL_OFF", "screen", kFull), "FULL_OFF")};
constexpr Parameter kStvw[] = {
    integer("view_id", "view", kViewIds),
    optional_labelled("VP", number("x y z", "viewpoint", Unit::mm), 3),
    optional_labelled("LP", number("x y z", "lookpoint", Unit::mm), 3),
    optional_labelled("TW", number("twist", "twist angle", Unit::degree)),
    optional_labelled("VA", number("angle", "viewing angle", Unit::degree, kOpeningAngle)),
    optional_labelled("FCP", number("d", "distance of the front clipping plane", Unit::mm, kNotNegative)),
    optional_labelled("BCP", number("d", "distance of the back clipping plane", Unit::mm, kNotNegative)),
    optional_labelled("STEPS", integer("n", "number of steps", {1, 1e6}), 1, 1),
    optional_labelled("TIME", number("s", "time", Unit::second, kSequenceTime), 1, 1),
};
constexpr Parameter kCovw[] = {integer("view_id", "view", kViewIds), camera()};
constexpr Parameter kMode[] = {choice("mode", "mode", kModes), on_off()};
constexpr Parameter kSwitch[] = {on_off()};

// The slots by which scripts/commands reads the values.
static_assert(has_slots(kDisplay, {slots::stdp::kDisplay, slots::stdp::kScreen}));
static_assert(has_slots(kStvw, {slots::stvw::kView, slots::stvw::kViewpoint, slots::stvw::kLookpoint,
                                slots::stvw::kTwist, slots::stvw::kAngle, slots::stvw::kFrontPlane,
                                slots::stvw::kBackPlane, slots::stvw::kSteps, slots::stvw::kTime}));
static_assert(has_slots(kCovw, {slots::covw::kView, slots::covw::kCamera}));
static_assert(has_slots(kMode, {slots::set_mode::kMode, slots::set_mode::kOn}));

constexpr Form kForms[] = {
    {.id = FormId::stdp,
     .name = "STDP",
     .syntax = "STDP <display_id> [FULL | FULL_OFF]",
     .section = kSection,
     .parameters = kDisplay,
     .help = "sets the display: 1 perspective, 2 top and side, 3 top, 4 side, 5 side in perspective, 6 bird's eye",
     .example = "STDP 1 FULL",
     .definition = "the default is FULL_OFF; the display's first view is the current one, whose axes SCREEN_INC uses; "
                   "FULL omits titles and legend"},
    {.id = FormId::stvw,
     .name = "STVW",
     .syntax = "STVW <view_id> [VP x y z] [LP x y z] [TW twist] [VA angle] [FCP d] [BCP d] [STEPS n | TIME s]",
     .section = kSection,
     .parameters = kStvw,
     .help = "sets parameters of a view, at once or as a sequence of n updates or s seconds",
     .example = "STVW 0 VP 519.7 -539 -850 LP 2183 9570 3391 TIME 15.0",
     .definition = "groups in any order, each at most once; at once without STEPS and TIME. Starts from the view's "
                   "present state, also during a sequence or at a camera (COVW), which it releases; all parameters "
                   "change evenly. STEPS counts updates of the picture, TIME is real time"},
    {.id = FormId::covw,
     .name = "COVW",
     .syntax = "COVW <view_id> <cam_id>",
     .section = kSection,
     .parameters = kCovw,
     .help = "binds a view to a camera, which it then follows",
     .example = "COVW 0 UMG_Kamera_1",
     .definition =
         "until STVW or LOAD_VIEWS sets the view, or the camera is deleted; the view keeps its clipping planes"},
    {.id = FormId::set_mode,
     .name = "SET_MODE",
     .syntax = "SET_MODE <mode> [on | off]",
     .section = kSection,
     .parameters = kMode,
     .help = "switches a mode of the display",
     .example = "SET_MODE TCP_DRAW on",
     .definition = "at the start FLDR, SHAD, TEXTURES, ANTIALIAS, GEO_VIS_TEST and LEGEND are on, the others off; "
                   "LEGEND is ours. SHAD on without the floor and CAM_MAINVIEW on without a camera are refused"},
    {.id = FormId::bfrm,
     .name = "BFRM",
     .syntax = "BFRM [on | off]",
     .section = kSection,
     .parameters = kSwitch,
     .help = "switches backface removal",
     .definition = "as SET_MODE BFRM"},
    {.id = FormId::fldr,
     .name = "FLDR",
     .syntax = "FLDR [on | off]",
     .section = kSection,
     .parameters = kSwitch,
     .help = "switches the floor",
     .definition = "as SET_MODE FLDR; without it shadows are invisible"},
    {.id = FormId::shad,
     .name = "SHAD",
     .syntax = "SHAD [on | off]",
     .section = kSection,
     .parameters = kSwitch,
     .help = "switches shadows",
     .definition = "as SET_MODE SHAD; on is refused without the floor"},
    {.id = FormId::wait,
     .name = "WAIT",
     .syntax = "WAIT",
     .section = kSection,
     .help = "suspends the SCRIPT file that contains it until all moves, robot programs and view sequences have ended",
     .example = "WAIT",
     .definition = "messages and other SCRIPT files continue; refused as a message of its own",
     .effect = LoopEffect::blocking},
};

}  // namespace

std::span<const Form> animation_forms() { return kForms; }

}  // namespace cellmirror::script
