// Manual 1.2.6: control of deformable objects, and the I/O channels.
#include "rt_core/base/capacity.hpp"
#include "scripts/lang/slots.hpp"
#include "scripts/lang/table_parts.hpp"

namespace cellmirror::script {

namespace {

using namespace parts;

constexpr std::string_view kSection = "1.2.6";

constexpr Choice kTests[] = {{"0", "no test, interaction off"},
                             {"1", "value >= testval1"},
                             {"2", "value < testval1"},
                             {"3", "testval1 <= value <= testval2"},
                             {"4", "value < testval1 or value > testval2"}};
constexpr Choice kInstruments[] = {{"0", "gripper"},
                                   {"1", "clip applicator"},
                                   {"2", "scissors"},
                                   {"3", "coagulation hook"},
                                   {"4", "coagulation forceps"}};

constexpr Range kEffectorJoint{1, static_cast<double>(kMaxJointsPerRobot)};
// Bounds keep the search for contacts within reach of the instrument.
constexpr Range kCylinderRadius{0.0, 200.0, true, false};
constexpr Range kCylinderLength{-kInfinity, 1000.0};
constexpr Range kForceBytes{12, 1048576};  // at least force x, y, z as float32; at most 1 MiB
constexpr Range kSwitchBytes{1, 1048576};

constexpr Parameter kCalc[] = {on_off()};
constexpr Parameter kInteract[] = {
    integer("int_jnt", "effector joint", kEffectorJoint), choice("test_function", "test function", kTests),
    number("testval1", "first test value", Unit::by_effector_joint),
    number("testval2", "second test value", Unit::by_effector_joint), choice("inst_type", "instrument", kInstruments)};
constexpr Parameter kClip[] = {
    file("clip_file", "clip geometry (.mpo)"),      number("rx", "rotation about x", Unit::degree),
    number("ry", "rotation about y", Unit::degree), number("rz", "rotation about z", Unit::degree),
    number("tx", "translation along x", Unit::mm),  number("ty", "translation along y", Unit::mm),
    number("tz", "translation along z", Unit::mm)};
constexpr Parameter kCylinders[] = {
    identifier("geo_name", "geometry of the effector"),
    integer("flags", "flags", kUnsigned),
    number("geom1", "shaft diameter", Unit::mm, kCylinderRadius),
    number("geom2", "mean distance of the jaws from the axis", Unit::mm, kCylinderRadius),
    number("geom3", "length of the effector", Unit::mm, kCylinderLength),
    number("geom4", "fourth value", Unit::none)};
constexpr Parameter kForceMemory[] = {integer("send_type", "protocol", kUnsigned),
                                      integer("re_shmkey", "shared memory key", kSharedMemoryKey),
                                      integer("re_buflen", "size", kForceBytes, Unit::byte)};
constexpr Parameter kSwitchMemory[] = {integer("send_type", "protocol", kUnsigned),
                                       integer("be_shmkey", "shared memory key", kSharedMemoryKey),
                                       integer("be_buflen", "size", kSwitchBytes, Unit::byte)};
constexpr Parameter kBinary[] = {choice("online | offline", "processing", kOnlineOffline)};
constexpr Parameter kMessage[] = {{.name = "text", .meaning = "message", .kind = ParameterKind::text}};

// The slots by which scripts/commands reads the values.
static_assert(has_slots(kInteract, {slots::instrument::kJoint, slots::instrument::kTest, slots::instrument::kFirstValue,
                                    slots::instrument::kSecondValue, slots::instrument::kKind}));
static_assert(has_slots(kClip, {slots::clip::kFile, slots::clip::kRotation, slots::clip::kTranslation}));
static_assert(has_slots(kCylinders,
                        {slots::effector_cylinders::kGeometry, slots::effector_cylinders::kFlags,
                         slots::effector_cylinders::kShaftDiameter, slots::effector_cylinders::kEffectorRadius,
                         slots::effector_cylinders::kEffectorLength, slots::effector_cylinders::kFourth}));
static_assert(has_slots(kForceMemory,
                        {slots::force_memory::kSendType, slots::force_memory::kKey, slots::force_memory::kBytes}));
static_assert(has_slots(kSwitchMemory,
                        {slots::switch_memory::kSendType, slots::switch_memory::kKey, slots::switch_memory::kBytes}));

constexpr Form kForms[] = {
    {.id = FormId::eladyn_calc,
     .name = "eladyn_calc",
     .syntax = "eladyn_calc [on | off]",
     .section = kSection,
     .parameters = kCalc,
     .help = "starts or stops the elastodynamic calculation",
     .definition = "off freezes all objects and what instruments do to them; on at the start"},
    {.id = FormId::rob_ela_interact,
     .name = "rob_ela_interact",
     .syntax = "rob_ela_interact <int_jnt> <test_function> <testval1> <testval2> <inst_type>",
     .section = kSection,
     .parameters = kInteract,
     .help = "sets which joint of the active robot triggers its instrument's action, and when",
     .definition = "joints are numbered from 1 as in the component file; test values are in mm or degrees by the kind "
                   "of the joint; test 0 removes the action",
     .needs_active_robot = true},
    {.id = FormId::ela_clip_def,
     .name = "ela_clip_def",
     .syntax = "ela_clip_def <clip_file> <rx> <ry> <rz> <tx> <ty> <tz>",
     .section = kSection,
     .parameters = kClip,
     .help = "sets geometry and pose of a clip at the effector",
     .definition =
         "the file is in envlib; the pose is relative to the TCP, rotations about fixed axes: x, then y, then z",
     .needs_active_robot = true},
    {.id = FormId::eladyn_geo_def_cylinders,
     .name = "eladyn_geo_def",
     .syntax = "eladyn_geo_def <geo_name> <flags> <geom1> <geom2> <geom3> <geom4>",
     .section = kSection,
     .parameters = kCylinders,
     .help = "sets the virtual cylinders of the active robot's effector for the contact test",
     .definition = "geo_name is a frame or joint whose geometry moves with the robot, or that geometry; the cylinders "
                   "lie on the z axis of the TCP: the effector with radius geom2 and length geom3 (18 mm unless more "
                   "than 0) ends at the TCP, behind it is the shaft; flags and geom4 are only kept and reported",
     .selector = Selector::by_shape,
     .needs_active_robot = true},
    {.id = FormId::rob_ela_shm,
     .name = "rob_ela_shm",
     .syntax = "rob_ela_shm <send_type> <re_shmkey> <re_buflen>",
     .section = kSection,
     .parameters = kForceMemory,
     .help = "sets the shared memory for forces and joint torques to a haptic device program",
     .definition = "for the active robot; from 12 bytes on: force x, y, z as float32, then the robot's joint torques "
                   "as far as they fit (the answer names those that do not), if its forces are computed; from 512 "
                   "bytes on: the memory of a haptic device, with our extensions; the key may be hexadecimal, not 0",
     .effect = LoopEffect::queued,
     .needs_active_robot = true},
    {.id = FormId::bin_ela_shm,
     .name = "bin_ela_shm",
     .syntax = "bin_ela_shm <send_type> <be_shmkey> <be_buflen>",
     .section = kSection,
     .parameters = kSwitchMemory,
     .help = "sets the shared memory from which binary inputs (foot switches) are read",
     .definition = "bit 0 of the first byte is BININP1, bit 0 of the second BININP9, and so on, up to 4096 bytes; the "
                   "key may be hexadecimal, not 0; BIN_ELA online starts the processing",
     .effect = LoopEffect::queued},
    {.id = FormId::binary_input_files,
     .name = "BININPn_ON.spt, BININPn_OFF.spt",
     .syntax = "files for n = 1..8, bit n-1",
     .section = kSection,
     .help = "the SCRIPT files that run when a binary input changes to on or off",
     .definition = "in scripts/ of the cell folder, once per change and one after another; inputs beyond 8 likewise",
     .kind = FormKind::convention},
    {.id = FormId::bin_ela,
     .name = "BIN_ELA",
     .syntax = "BIN_ELA [online | offline]",
     .section = kSection,
     .parameters = kBinary,
     .help = "switches the processing of binary inputs",
     .definition = "inputs that are on when processing starts are the initial state: no file runs for them",
     .effect = LoopEffect::queued},
    {.id = FormId::hot_message,
     .name = "hot_message",
     .syntax = "hot_message <text>",
     .section = kSection,
     .parameters = kMessage,
     .help = "shows a text for about 5 s",
     .definition = "UTF-8: in a file up to the next ';', in a message to its end, without a final ';'; shown in every "
                   "picture, on the page, in status and log. With SET_MODE BEEP a bell, too"},
};

}  // namespace

std::span<const Form> channel_forms() { return kForms; }

}  // namespace cellmirror::script
