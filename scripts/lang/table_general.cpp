// Manual 1.2.1: general commands, but for those that concern one robot, camera or sensor.
#include <algorithm>
#include <array>
#include <vector>

#include "scripts/lang/slots.hpp"
#include "scripts/lang/table_parts.hpp"
#include "scripts/programs/languages/languages.hpp"

namespace cellmirror::script {

namespace {

using namespace parts;

constexpr std::string_view kSection = "1.2.1";

constexpr Choice kExecWait[] = {{"exec_wait", "queue after the robot's running program"}};

constexpr Parameter kComment[] = {{.name = "text", .meaning = "comment", .kind = ParameterKind::text}};
constexpr Parameter kFrame[] = {frame()};
// Nodes that are not in memory yet may be activated: the gateway looks the name up in the component files.
constexpr Parameter kUnloadedFrame[] = {{.name = "frame_node",
                                         .meaning = "frame or joint",
                                         .kind = ParameterKind::name,
                                         .name_kind = NameKind::frame_node,
                                         .checked_by_host = true}};
constexpr Parameter kRobot[] = {robot()};
constexpr Parameter kProgramOfRobot[] = {file("teach_filename", "robot program"), robot()};
constexpr Parameter kRun[] = {file("teach_filename", "robot program"), robot(),
                              optional(choice("exec_wait", "start", kExecWait), "at once")};
constexpr Parameter kViewFile[] = {file("view_filename", "view file")};
constexpr Parameter kScriptFile[] = {file("script_file", "SCRIPT file")};
constexpr Parameter kConnect[] = {frame("frame_2", "frame to attach"), word("TO"),
                                  frame("frame_1", "its new predecessor")};
constexpr Parameter kFrameToWorkframe[] = {frame("frame_2", "frame to attach"), word("TO"),
                                           frame("frame_1", "its new predecessor"),
                                           named(NameKind::workframe, "WFRM_name1", "workframe")};

// The slots by which scripts/commands reads the values.
static_assert(has_slots(kProgramOfRobot, {slots::program::kProgram, slots::program::kRobot}));
static_assert(has_slots(kRun, {slots::program::kProgram, slots::program::kRobot, slots::program::kExecWait}));
static_assert(has_slots(kConnect, {slots::connect::kAttached, slots::connect::kPredecessor}));
static_assert(has_slots(kFrameToWorkframe,
                        {slots::connect::kAttached, slots::connect::kPredecessor, slots::connect::kWorkframe}));

constexpr Form kForms[] = {
    {.id = FormId::comment,
     .name = "#",
     .syntax = "# text",
     .section = kSection,
     .parameters = kComment,
     .help = "a line with # in column 1 is a comment",
     .example = "# This is an example of a comment line",
     .definition = "allowed between the lines of a command, and as a message",
     .kind = FormKind::convention},
    {.id = FormId::activate,
     .name = "ACTIVATE",
     .syntax = "ACTIVATE <frame_node>",
     .section = kSection,
     .parameters = kUnloadedFrame,
     .help = "shows a branch and includes it in collision tests; loads its component file if it is not in memory",
     .example = "ACTIVATE Testlab_1.FL_Klein.Flansch_Typ1",
     .definition = "refused on a node without a component file; the name is looked up at execution",
     .effect = LoopEffect::queued},
    {.id = FormId::deactivate,
     .name = "DEACTIVATE",
     .syntax = "DEACTIVATE <frame_node>",
     .section = kSection,
     .parameters = kFrame,
     .help = "keeps a branch in memory, but out of the picture and of collision tests",
     .example = "DEACTIVATE Testlab_1.FL_Klein.Flansch_Typ1",
     .definition = "refused on a part that is neither in memory nor shown",
     .effect = LoopEffect::queued},
    {.id = FormId::delete_node,
     .name = "DELETE_NODE",
     .syntax = "DELETE_NODE <frame_node>",
     .section = kSection,
     .parameters = kFrame,
     .help = "removes a branch from the model in memory; its file stays",
     .example = "DELETE_NODE Testlab_1.FL_Klein.Flansch_Typ1",
     .definition = "ACTIVATE loads the part again as in its files, without the effects of SET_FRAME PLACEMENT, CONNECT "
                   "and FRAME_TO_WFRM",
     .effect = LoopEffect::queued},
    {.id = FormId::swap_node,
     .name = "SWAP_NODE",
     .syntax = "SWAP_NODE <frame_node>",
     .section = kSection,
     .parameters = kFrame,
     .help = "exchanges a node's detailed geometry for its father's coarse one, or back",
     .example = "SWAP_NODE Testlab_1.FL_Klein.Flansch_Typ1",
     .definition = "refused on a node without a component file or father geometry",
     .effect = LoopEffect::queued},
    {.id = FormId::level_down,
     .name = "LEVEL_DOWN",
     .syntax = "LEVEL_DOWN <frame_node>",
     .section = kSection,
     .parameters = kFrame,
     .help = "loads and activates one more layer of details below a node and swaps the father's geometry out",
     .example = "LEVEL_DOWN Testlab_1.FL_Klein",
     .conflict = "refused after the example of SWAP_NODE, which shows the only details below this node",
     .definition = "refused on a node without a component file below it",
     .effect = LoopEffect::queued},
    {.id = FormId::level_up,
     .name = "LEVEL_UP",
     .syntax = "LEVEL_UP <frame_node>",
     .section = kSection,
     .parameters = kFrame,
     .help = "deactivates the next layer of details below a node",
     .example = "LEVEL_UP Testlab_1.FL_Klein",
     .effect = LoopEffect::queued},
    {.id = FormId::robot_language,
     .name = "ROBOT_LANGUAGE",
     .syntax = "ROBOT_LANGUAGE <language>",
     .section = kSection,
     .parameters = {},  // general_forms()
     .help = "sets the language in which robot programs loaded after it are parsed",
     .example = "ROBOT_LANGUAGE jet_tarm",
     .definition = "the default is irdata, as in the manual; irdata, srcl, jet_boom and jet_tarm are our dialects "
                   "(docs/robot-programs.md); the manual does not have the others"},
    {.id = FormId::robact,
     .name = "ROBACT",
     .syntax = "ROBACT <Robot_id>",
     .section = kSection,
     .parameters = kRobot,
     .help = "activates a robot for commands without a robot's name",
     .example = "ROBACT PUMA_762"},
    {.id = FormId::tf_load,
     .name = "TF_LOAD",
     .syntax = "TF_LOAD <teach_filename> <Robot_id>",
     .section = kSection,
     .parameters = kProgramOfRobot,
     .help = "loads and validates a robot program for a robot without starting it",
     .example = "TF_LOAD r3demo mantec_R3",
     .conflict = "after the example of ROBOT_LANGUAGE it needs a jet_tarm program; our r3demo is irdata",
     .definition =
         "searched in the cell folder's programs, then in scripts, with and without the extensions of the language; a "
         "program with any error is not loaded; one of the same name is replaced unless it runs or is queued"},
    {.id = FormId::tf_run,
     .name = "TF_RUN",
     .syntax = "TF_RUN <teach_filename> <Robot_id> [exec_wait]",
     .section = kSection,
     .parameters = kRun,
     .help = "starts a loaded robot program, or queues it after the robot's running one",
     .example = "TF_RUN hs2 ZELLENKRAN exec_wait",
     .conflict = "refused until TF_LOAD loads r3demo2, hs1, hs2 and hs3; no example does",
     .definition =
         "refused if the program is not loaded for the robot, runs, or is queued, and, without exec_wait, while "
         "another program of the robot runs; done when started or queued; WAIT and TF_WAIT wait for its end",
     .effect = LoopEffect::queued},
    {.id = FormId::tf_delete,
     .name = "TF_DELETE",
     .syntax = "TF_DELETE <teach_filename> <Robot_id>",
     .section = kSection,
     .parameters = kProgramOfRobot,
     .help = "removes a robot program from a robot's virtual controller",
     .example = "TF_DELETE ird_getschr MANTEC_RM3",
     .conflict = "refused until TF_LOAD loads ird_getschr; no example does",
     .definition = "refused while the program runs or is queued"},
    {.id = FormId::load_views,
     .name = "LOAD_VIEWS",
     .syntax = "LOAD_VIEWS <view_filename>",
     .section = kSection,
     .parameters = kViewFile,
     .help = "sets the views that a file of the cell folder's scripts contains (default extension .vws)",
     .example = "LOAD_VIEWS view1.vws",
     .definition = "the format is ours (docs/cell-files.md); a faulty file changes nothing; views that a file does not "
                   "contain stay unchanged"},
    {.id = FormId::exec_script,
     .name = "EXEC_SCRIPT",
     .syntax = "EXEC_SCRIPT <script_file>",
     .section = kSection,
     .parameters = kScriptFile,
     .help = "calls another SCRIPT file (default extension .spt) like a subroutine",
     .example = "EXEC_SCRIPT trs_demo.spt",
     .definition = "refused for a file in the call chain, beyond a depth of 32, and for a file with syntax errors",
     .effect = LoopEffect::none},
    {.id = FormId::draw_scene,
     .name = "DRAW_SCENE",
     .syntax = "DRAW_SCENE",
     .section = kSection,
     .help = "recalculates the kinematics and renders the views",
     .example = "DRAW_SCENE",
     .definition = "done when the render thread has the new positions; rendering is continuous, so the command matters "
                   "only after a jump of a robot",
     .effect = LoopEffect::queued},
    {.id = FormId::connect,
     .name = "CONNECT",
     .syntax = "CONNECT <frame_2> TO <frame_1>",
     .section = kSection,
     .parameters = kConnect,
     .help = "makes frame_1 the predecessor of frame_2, which keeps its pose and moves along from then on",
     .example = "CONNECT Testlab_1.FL_Klein_02.Flansch_Typ1 TO Mantec_1.HAND",
     .definition = "making a frame its own ancestor is refused",
     .effect = LoopEffect::queued},
    {.id = FormId::frame_to_wfrm,
     .name = "FRAME_TO_WFRM",
     .syntax = "FRAME_TO_WFRM <frame_2> TO <frame_1> <WFRM_name1>",
     .section = kSection,
     .parameters = kFrameToWorkframe,
     .help = "makes frame_1 the predecessor of frame_2, which jumps to the pose that the workframe defines",
     .example = "FRAME_TO_WFRM Toolbox.Tool1 TO Mantec_1.HAND Tool1_WFRM",
     .definition = "frame_2 moves along, as in CONNECT; making a frame its own ancestor is refused",
     .effect = LoopEffect::queued},
};

}  // namespace

// The languages are those that are registered, so that a new one is registered in one place.
std::span<const Form> general_forms() {
  static const std::vector<Choice> choices = [] {
    std::vector<Choice> all;
    for (const program::Language& language : program::languages()) all.push_back({language.name, language.summary});
    return all;
  }();
  static const std::array<Parameter, 1> language = {choice("language", "robot language", choices)};
  static const auto forms = [] {
    auto all = std::to_array(kForms);
    std::ranges::find(all, FormId::robot_language, &Form::id)->parameters = language;
    return all;
  }();
  return forms;
}

}  // namespace cellmirror::script
