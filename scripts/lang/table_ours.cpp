// Commands that the manual does not have.
#include "scripts/lang/slots.hpp"
#include "scripts/lang/table_parts.hpp"

namespace cellmirror::script {

namespace {

using namespace parts;

constexpr std::string_view kSection = "ours";

constexpr Range kWarningDistance{0.0, 100000.0, false, false};

constexpr Choice kPositionings[] = {{"move", "POS_ROB moves the robot, the default"},
                                    {"jump", "POS_ROB sets the robot to its target at once"}};
constexpr Choice kPaths[] = {{"PTP", "point to point"}, {"LIN", "the TCP on a straight line"}};
constexpr Choice kPtpOnly[] = {{"PTP", "point to point"}};

constexpr Parameter kViewFile[] = {file("view_filename", "view file")};
constexpr Parameter kFlight[] = {file("file", "flight record")};
constexpr Parameter kPositioning[] = {choice("move | jump", "positioning", kPositionings)};

constexpr Parameter kPath = choice("PTP | LIN", "path", kPaths);
constexpr Parameter kX = optional_labelled("X", number("x", "increment along x", Unit::mm));
constexpr Parameter kY = optional_labelled("Y", number("y", "increment along y", Unit::mm));
constexpr Parameter kZ = optional_labelled("Z", number("z", "increment along z", Unit::mm));
constexpr Parameter kA = optional_labelled("A", number("r", "roll increment", Unit::degree));
constexpr Parameter kB = optional_labelled("B", number("p", "pitch increment", Unit::degree));
constexpr Parameter kC = optional_labelled("C", number("y", "yaw increment", Unit::degree));

constexpr Parameter kJointAbs[] = {robot(), kPath, word("JOINT_ABS"), some_joints("joint position")};
constexpr Parameter kJointInc[] = {robot(), kPath, word("JOINT_INC"), some_joints("joint increment")};
constexpr Parameter kFrameAbs[] = {robot(),
                                   kPath,
                                   word("FRAME_ABS"),
                                   number("x", "x", Unit::mm),
                                   number("y", "y", Unit::mm),
                                   number("z", "z", Unit::mm),
                                   number("r", "roll", Unit::degree),
                                   number("p", "pitch", Unit::degree),
                                   number("y", "yaw", Unit::degree)};
constexpr Parameter kFrameInc[] = {robot(), kPath, word("FRAME_INC"), kX, kY, kZ, kA, kB, kC};
constexpr Parameter kToolInc[] = {robot(), kPath, word("TOOL_INC"), kX, kY, kZ, kA, kB, kC};
constexpr Parameter kScreenInc[] = {robot(), kPath, word("SCREEN_INC"), kX, kY, kZ, kA, kB, kC};
constexpr Parameter kStart[] = {robot(), choice("PTP", "path", kPtpOnly), word("START")};
constexpr Parameter kReference[] = {robot(), choice("PTP", "path", kPtpOnly), word("REFERENCE")};
constexpr Parameter kStop[] = {robot()};
constexpr Parameter kResetHaptic[] = {robot()};

constexpr Choice kPairTreatments[] = {
    {"ignore", "not tested"}, {"test", "tested, whatever was derived"}, {"derive", "the rule is removed"}};
constexpr Parameter kCollisionActive[] = {word("active"), choice("0 | 1", "switch", kZeroOne)};
constexpr Parameter kCollisionWarning[] = {word("warning"),
                                           number("distance", "warning distance", Unit::mm, kWarningDistance)};
constexpr Parameter kCollisionPair[] = {word("pair"), named(NameKind::branch, "node_a", "first frame or joint"),
                                        named(NameKind::branch, "node_b", "second frame or joint"),
                                        choice("ignore | test | derive", "treatment", kPairTreatments)};

// In the order of RecordAction.
constexpr Choice kRecordActions[] = {
    {"ON", "records"}, {"OFF", "ends the recording"}, {"KEEP", "keeps what the black box has, and the next seconds"}};
constexpr Parameter kBlackBox[] = {choice("ON | OFF | KEEP", "action", kRecordActions)};

constexpr Range kAlarmNumber{1.0, 1.0e12, false, false};
constexpr Parameter kAlarmAck[] = {
    identifier("name", "who acknowledges"),
    optional(integer("alarm", "number of the alarm, from the page or `cellmirror status --json`", kAlarmNumber),
             "all alarms")};
static_assert(has_slots(kAlarmAck, {slots::alarm_ack::kName, slots::alarm_ack::kAlarm}));

constexpr Parameter kSuction[] = {word("SUCTION"), choice("ON | OFF", "switch", kOnOff)};
constexpr Parameter kIrrigation[] = {word("IRRIGATION"), choice("ON | OFF", "switch", kOnOff)};

constexpr Parameter kSurface[] = {
    on_off(), optional_labelled("VALUE", number("value", "value of the surface", Unit::none)), one_volume()};
static_assert(has_slots(kSurface,
                        {slots::volume_surface::kOn, slots::volume_surface::kValue, slots::volume_surface::kVolume}));

constexpr Range kPortNumber{1.0, 1024.0, false, false};
constexpr Choice kStepDirections[] = {{"FORWARD", "in program order"},
                                      {"BACKWARD", "back to the previous check point"}};
constexpr Choice kRecordSteps[] = {{"START", "begins a recording"},
                                   {"POINT", "a check point where the robot is now"},
                                   {"STOP", "ends the recording and writes the file"}};
constexpr Range kRunNumber{1.0, 9.0e15, false, false};
constexpr Parameter kRun[] = {integer("run", "number of the run, from `cellmirror status`", kRunNumber)};
constexpr Parameter kProgramRobot[] = {robot()};
constexpr Parameter kProgramOfRobot[] = {file("teach_filename", "robot program"), robot()};
constexpr Parameter kStep[] = {robot(), optional(choice("direction", "direction", kStepDirections), "FORWARD")};
constexpr Parameter kRecord[] = {file("teach_filename", "robot program"), robot(),
                                 choice("START | POINT | STOP", "what to do", kRecordSteps),
                                 optional(identifier("point", "name of the check point"))};
constexpr Parameter kDigitalInput[] = {robot(), integer("number", "digital input", kPortNumber), on_off()};
constexpr Parameter kAnalogueInput[] = {robot(), integer("number", "analogue input", kPortNumber),
                                        number("value", "value", Unit::none)};

constexpr std::string_view kQueued =
    "starts after all earlier moves of the robot; done when queued (at most 32 per robot)";
constexpr std::string_view kQueuedIncrement =
    "as in POS_ROB, but from the end of the robot's previous move, and starts then";

constexpr Form move_form(FormId id, std::string_view syntax, std::span<const Parameter> parameters,
                         std::string_view help, std::string_view example) {
  return {.id = id,
          .name = "MOVE_ROB",
          .syntax = syntax,
          .section = kSection,
          .parameters = parameters,
          .help = help,
          .example = example,
          .definition = kQueued,
          .effect = LoopEffect::queued,
          .selector = Selector::by_third_word,
          .origin = Origin::ours};
}

constexpr Form increment_form(FormId id, std::string_view syntax, std::span<const Parameter> parameters,
                              std::string_view help, std::string_view example) {
  Form form = move_form(id, syntax, parameters, help, example);
  form.definition = kQueuedIncrement;
  form.commas = true;
  form.at_least_one = true;
  return form;
}

// The slots by which scripts/commands reads the values.
static_assert(has_slots(kCollisionPair,
                        {slots::collision_pair::kA, slots::collision_pair::kB, slots::collision_pair::kTreatment}));
static_assert(has_slots(kProgramOfRobot, {slots::program::kProgram, slots::program::kRobot}));
static_assert(has_slots(kStep, {slots::program_step::kRobot, slots::program_step::kDirection}));
static_assert(has_slots(kRecord, {slots::program::kProgram, slots::program::kRobot, slots::program::kRecordStep,
                                  slots::program::kPoint}));
static_assert(has_slots(kDigitalInput,
                        {slots::program_input::kRobot, slots::program_input::kNumber, slots::program_input::kOn}));
static_assert(has_slots(kAnalogueInput,
                        {slots::program_input::kRobot, slots::program_input::kNumber, slots::program_input::kValue}));
static_assert(has_slots(kJointAbs,
                        {slots::move_rob::kRobot, slots::move_rob::kPath, {slots::move_rob::kTarget, 3, "j1 ... jn"}}));
static_assert(has_slots(kFrameAbs,
                        {slots::move_rob::kRobot, slots::move_rob::kPath, {slots::move_rob::kTarget, 3, "x"}}));
static_assert(has_slots(kFrameInc,
                        {slots::move_rob::kRobot, slots::move_rob::kPath, {slots::move_rob::kTarget, 3, "X"}}));
static_assert(has_slots(kToolInc,
                        {slots::move_rob::kRobot, slots::move_rob::kPath, {slots::move_rob::kTarget, 3, "X"}}));
static_assert(has_slots(kScreenInc,
                        {slots::move_rob::kRobot, slots::move_rob::kPath, {slots::move_rob::kTarget, 3, "X"}}));

constexpr Form kForms[] = {
    {.id = FormId::save_flight,
     .name = "SAVE_FLIGHT",
     .syntax = "SAVE_FLIGHT <file>",
     .section = kSection,
     .parameters = kFlight,
     .help = "writes the flight recorder into the cell folder's records",
     .example = "SAVE_FLIGHT before_stop.csv",
     .definition = "a plain file name without folders",
     .origin = Origin::ours},
    {.id = FormId::rob_positioning,
     .name = "rob_positioning",
     .syntax = "rob_positioning [move | jump]",
     .section = kSection,
     .parameters = kPositioning,
     .help = "sets whether POS_ROB moves the active robot or sets it to its target at once",
     .example = "rob_positioning move",
     .definition = "with jump, only the ranges of the joints are limits; MOVE_ROB always moves",
     .origin = Origin::ours,
     .needs_active_robot = true},
    move_form(FormId::move_rob_joint_abs, "MOVE_ROB <Robot_id> [PTP | LIN] JOINT_ABS <j1> ... <jn>", kJointAbs,
              "moves a robot's joints to positions", "MOVE_ROB MANTEC_RM3 PTP JOINT_ABS 10 20 30"),
    move_form(FormId::move_rob_joint_inc, "MOVE_ROB <Robot_id> [PTP | LIN] JOINT_INC <j1> ... <jn>", kJointInc,
              "moves a robot's joints by increments", "MOVE_ROB MANTEC_RM3 PTP JOINT_INC 0 5"),
    move_form(FormId::move_rob_frame_abs, "MOVE_ROB <Robot_id> [PTP | LIN] FRAME_ABS <x> <y> <z> <r> <p> <y>",
              kFrameAbs, "moves a robot's TCP to a pose in its ZP frame",
              "MOVE_ROB mantec_R3a PTP FRAME_ABS 600 300 900 180 0 0"),
    increment_form(FormId::move_rob_frame_inc,
                   "MOVE_ROB <Robot_id> [PTP | LIN] FRAME_INC [X x] [Y y] [Z z] [A r] [B p] [C y]", kFrameInc,
                   "moves a robot's TCP by an increment in its ZP frame", "MOVE_ROB MANTEC_RM3 LIN FRAME_INC X 20"),
    increment_form(FormId::move_rob_tool_inc,
                   "MOVE_ROB <Robot_id> [PTP | LIN] TOOL_INC [X x] [Y y] [Z z] [A r] [B p] [C y]", kToolInc,
                   "moves a robot's TCP by an increment in its TCP frame", "MOVE_ROB MANTEC_RM3 LIN TOOL_INC Z -20"),
    increment_form(FormId::move_rob_screen_inc,
                   "MOVE_ROB <Robot_id> [PTP | LIN] SCREEN_INC [X x] [Y y] [Z z] [A r] [B p] [C y]", kScreenInc,
                   "moves a robot's TCP by an increment in the space of the display",
                   "MOVE_ROB MANTEC_RM3 LIN SCREEN_INC Y 10"),
    move_form(FormId::move_rob_start, "MOVE_ROB <Robot_id> PTP START", kStart,
              "moves a robot to its start position, rob_jnt_start_pos", "MOVE_ROB MANTEC_RM3 PTP START"),
    move_form(FormId::move_rob_reference, "MOVE_ROB <Robot_id> PTP REFERENCE", kReference,
              "moves a robot to its reference position, rob_jnt_ref_pos", "MOVE_ROB MANTEC_RM3 PTP REFERENCE"),
    {.id = FormId::stop_rob,
     .name = "STOP_ROB",
     .syntax = "STOP_ROB <Robot_id>",
     .section = kSection,
     .parameters = kStop,
     .help = "brakes a robot's move on its path and discards queued moves",
     .example = "STOP_ROB MANTEC_RM3",
     .definition = "done when the loop has received it; a stopped POS_ROB is refused to its client",
     .effect = LoopEffect::queued,
     .origin = Origin::ours},
    {.id = FormId::set_collpar_active,
     .name = "SET_COLLPAR",
     .syntax = "SET_COLLPAR active [0 | 1]",
     .section = kSection,
     .parameters = kCollisionActive,
     .help = "switches collision tests off or on",
     .example = "SET_COLLPAR active 0",
     .definition = "earlier results stay in status with their age",
     .selector = Selector::by_first_word,
     .origin = Origin::ours},
    {.id = FormId::set_collpar_warning,
     .name = "SET_COLLPAR",
     .syntax = "SET_COLLPAR warning <distance>",
     .section = kSection,
     .parameters = kCollisionWarning,
     .help = "sets the distance below which a pair of bodies is reported as near",
     .example = "SET_COLLPAR warning 50.0",
     .selector = Selector::by_first_word,
     .origin = Origin::ours},
    {.id = FormId::set_collpar_pair,
     .name = "SET_COLLPAR",
     .syntax = "SET_COLLPAR pair <node_a> <node_b> [ignore | test | derive]",
     .section = kSection,
     .parameters = kCollisionPair,
     .help = "sets whether bodies of two branches are tested against each other",
     .example = "SET_COLLPAR pair Toolbox.Tool1 Mantec_1.HAND ignore",
     .definition = "a frame stands for itself and everything below it by name, the cell's name for the cell's own "
                   "geometry; the newest matching rule applies, before those of the cell file; derive removes the "
                   "rules for exactly these two, also those of the cell file",
     .selector = Selector::by_first_word,
     .origin = Origin::ours},
    {.id = FormId::reset_haptic,
     .name = "RESET_HAPTIC",
     .syntax = "RESET_HAPTIC <Robot_id>",
     .section = kSection,
     .parameters = kResetHaptic,
     .help = "resets the latched fault of a haptic device, which removed its force",
     .example = "RESET_HAPTIC MANTEC_RM3",
     .definition = "forces fade in again; refused if the robot has no haptic device",
     .effect = LoopEffect::queued,
     .origin = Origin::ours},
    {.id = FormId::save_views,
     .name = "SAVE_VIEWS",
     .syntax = "SAVE_VIEWS <view_filename>",
     .section = kSection,
     .parameters = kViewFile,
     .help = "writes the seven views, their cameras and the display into a file (.vws) of the cell folder's scripts",
     .example = "SAVE_VIEWS my_views.vws",
     .definition = "a plain file name without folders; a file of that name is replaced; a view in a sequence is saved "
                   "in its final state",
     .origin = Origin::ours},
    {.id = FormId::tf_back,
     .name = "TF_BACK",
     .syntax = "TF_BACK <teach_filename> <Robot_id>",
     .section = kSection,
     .parameters = kProgramOfRobot,
     .help = "runs a loaded robot program backward, from its last check point to its first",
     .example = "TF_BACK r3_taught mantec_R3",
     .definition = "for programs of check points (jet_boom, jet_tarm); skips comments and outputs; refused like TF_RUN",
     .effect = LoopEffect::queued,
     .origin = Origin::ours},
    {.id = FormId::tf_hold,
     .name = "TF_HOLD",
     .syntax = "TF_HOLD <Robot_id>",
     .section = kSection,
     .parameters = kProgramRobot,
     .help = "holds the running robot program: the robot brakes on its path and waits there",
     .example = "TF_HOLD MANTEC_RM3",
     .definition =
         "within the robot's accelerations; meanwhile nothing of the program executes, and no time limit runs",
     .effect = LoopEffect::queued,
     .origin = Origin::ours},
    {.id = FormId::tf_resume,
     .name = "TF_RESUME",
     .syntax = "TF_RESUME <Robot_id>",
     .section = kSection,
     .parameters = kProgramRobot,
     .help = "resumes a held robot program on its path",
     .example = "TF_RESUME MANTEC_RM3",
     .definition = "also after the PAUSE of a program and after TF_STEP",
     .effect = LoopEffect::queued,
     .origin = Origin::ours},
    {.id = FormId::tf_step,
     .name = "TF_STEP",
     .syntax = "TF_STEP <Robot_id> [FORWARD | BACKWARD]",
     .section = kSection,
     .parameters = kStep,
     .help = "executes one move of a held robot program, and holds it again",
     .example = "TF_STEP MANTEC_RM3 FORWARD",
     .definition = "statements before that move execute, too; BACKWARD for programs of check points only",
     .effect = LoopEffect::queued,
     .origin = Origin::ours},
    {.id = FormId::tf_stop,
     .name = "TF_STOP",
     .syntax = "TF_STOP <Robot_id>",
     .section = kSection,
     .parameters = kProgramRobot,
     .help = "ends the running robot program and discards queued ones; the robot brakes",
     .example = "TF_STOP MANTEC_RM3",
     .definition = "effective at once, also in endless loops; refused if none runs; STOP_ROB does the same if a "
                   "program moves the robot",
     .effect = LoopEffect::queued,
     .origin = Origin::ours},
    {.id = FormId::tf_wait,
     .name = "TF_WAIT",
     .syntax = "TF_WAIT <Robot_id>",
     .section = kSection,
     .parameters = kProgramRobot,
     .help = "waits until the robot's programs have ended",
     .example = "TF_WAIT MANTEC_RM3",
     .definition = "suspends the SCRIPT file that contains it; a message is answered at that time; refused with the "
                   "reason if a program fails; not allowed in robot programs",
     .effect = LoopEffect::blocking,
     .origin = Origin::ours},
    {.id = FormId::tf_record,
     .name = "TF_RECORD",
     .syntax = "TF_RECORD <teach_filename> <Robot_id> [START | POINT | STOP] [point]",
     .section = kSection,
     .parameters = kRecord,
     .help = "records a teach file (jet_boom, jet_tarm) from the motion of a robot",
     .example = "TF_RECORD taught PUMA_762 START",
     .definition = "check points are created where the robot rests and at POINT; STOP writes the file into the cell "
                   "folder's programs; the language is that of ROBOT_LANGUAGE if it is one of the two, else jet_boom",
     .origin = Origin::ours},
    {.id = FormId::set_input,
     .name = "SET_INPUT",
     .syntax = "SET_INPUT <Robot_id> <number> [on | off]",
     .section = kSection,
     .parameters = kDigitalInput,
     .help = "sets a digital input of a robot's virtual controller",
     .example = "SET_INPUT MANTEC_RM3 3 on",
     .definition = "initially all are off",
     .origin = Origin::ours},
    {.id = FormId::set_analog_input,
     .name = "SET_ANALOG_INPUT",
     .syntax = "SET_ANALOG_INPUT <Robot_id> <number> <value>",
     .section = kSection,
     .parameters = kAnalogueInput,
     .help = "sets an analogue input of a robot's virtual controller",
     .example = "SET_ANALOG_INPUT MANTEC_RM3 1 4.75",
     .definition = "initially all are 0; the program defines the unit",
     .origin = Origin::ours},
    {.id = FormId::stop_all,
     .name = "STOP_ALL",
     .syntax = "STOP_ALL",
     .section = kSection,
     .parameters = {},
     .help = "ends all SCRIPT files and robot programs, and brakes all moves",
     .example = "STOP_ALL",
     .definition = "effective at once, also in endless loops; ends also the SCRIPT file that contains it; waiting "
                   "files of foot switches are not started; moves of mirrored robots continue, since their controllers "
                   "make them; not a safety function",
     .effect = LoopEffect::queued,
     .origin = Origin::ours},
    {.id = FormId::stop_script,
     .name = "STOP_SCRIPT",
     .syntax = "STOP_SCRIPT <run>",
     .section = kSection,
     .parameters = kRun,
     .help = "ends a SCRIPT file that is being executed, with the files that it has called",
     .example = "STOP_SCRIPT 3",
     .definition = "`cellmirror status` lists the runs and their numbers; what the last command began continues",
     .origin = Origin::ours},
    {.id = FormId::effects_suction,
     .name = "EFFECTS",
     .syntax = "EFFECTS SUCTION [ON | OFF]",
     .section = kSection,
     .parameters = kSuction,
     .help = "switches suction at the TCP of the active robot",
     .example = "EFFECTS SUCTION ON",
     .definition = "lowers the pool while the TCP is in it and clears smoke; the robot that is active at ON stays the "
                   "tool; OFF needs no active robot",
     .selector = Selector::by_first_word,
     .origin = Origin::ours},
    {.id = FormId::effects_irrigation,
     .name = "EFFECTS",
     .syntax = "EFFECTS IRRIGATION [ON | OFF]",
     .section = kSection,
     .parameters = kIrrigation,
     .help = "switches a jet of water at the TCP of the active robot",
     .example = "EFFECTS IRRIGATION ON",
     .definition = "raises and clears the pool, with ripples (POOL_RIPPLES); the tool as with SUCTION",
     .selector = Selector::by_first_word,
     .origin = Origin::ours},
    {.id = FormId::vv_iso,
     .name = "VV_ISO",
     .syntax = "VV_ISO [on | off] [VALUE <value>]",
     .section = kSection,
     .parameters = kSurface,
     .help = "draws the surface of one value of a volume in place of its look-up table",
     .example = "VV_ISO on VALUE 300",
     .definition = "lit and opaque; the value is in the volume's unit (Hounsfield units for computed tomography), by "
                   "default the one before; off draws with the table again; planes and volumes as with VV_CLIP",
     .origin = Origin::ours},
    {.id = FormId::record,
     .name = "RECORD",
     .syntax = "RECORD [ON | OFF | KEEP]",
     .section = kSection,
     .parameters = kBlackBox,
     .help = "switches the black box of the cell, or keeps its files",
     .example = "RECORD KEEP",
     .definition =
         "needs `[record]` in the cell file; kept files are renamed, so that newer ones do not replace them; what "
         "`cellmirror record` writes is not touched",
     .origin = Origin::ours},
    {.id = FormId::alarm_ack,
     .name = "ALARM_ACK",
     .syntax = "ALARM_ACK <name> [alarm]",
     .section = kSection,
     .parameters = kAlarmAck,
     .help = "acknowledges an alarm, or all of them",
     .example = "ALARM_ACK Ada 12",
     .definition = "the name is one word of at most 64 bytes that does not begin with a digit; the list of alarms "
                   "shows it to all users; an alarm acknowledged before keeps its name",
     .origin = Origin::ours},
};

}  // namespace

std::span<const Form> own_forms() { return kForms; }

}  // namespace cellmirror::script
