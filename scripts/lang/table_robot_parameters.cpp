// Manual 1.2.2: parameters of the active robot.
#include "rt_core/ports/words.hpp"
#include "scripts/lang/slots.hpp"
#include "scripts/lang/table_parts.hpp"

namespace cellmirror::script {

namespace {

using namespace parts;

constexpr std::string_view kSection = "1.2.2";

constexpr Range kScale{0.01, 1.0};

constexpr Choice kPtpModes[] = {{"sync", "all axes end together, the default"}, {"async", "each at its own time"}};
constexpr Choice kProfiles[] = {{"sine", "sinusoidal, the default"}, {"ramp", "with a jump of the acceleration"}};
// In the order of InverseClass.
constexpr Choice kInverseClasses[] = {
    {cellmirror::word(InverseClass::align_frame), "position and orientation"},
    {cellmirror::word(InverseClass::align_pos), "position only"},
    {cellmirror::word(InverseClass::align_x_axis), "position along x; orientation as well as possible"},
    {cellmirror::word(InverseClass::align_y_axis), "position along y; orientation as well as possible"},
    {cellmirror::word(InverseClass::align_z_axis), "position along z; orientation as well as possible"},
    {cellmirror::word(InverseClass::align_xy_axis), "position in xy; orientation as well as possible"},
    {cellmirror::word(InverseClass::align_yz_axis), "position in yz; orientation as well as possible"},
    {cellmirror::word(InverseClass::align_xz_axis), "position in xz; orientation as well as possible"},
    {cellmirror::word(InverseClass::align_n_axis), "position and the n vector"},
    {cellmirror::word(InverseClass::align_s_axis), "position and the s vector"},
    {cellmirror::word(InverseClass::align_a_axis), "position and the a vector"},
    {cellmirror::word(InverseClass::align_xy_n_axis), "position in xy and the n vector"},
    {cellmirror::word(InverseClass::align_xy_s_axis), "position in xy and the s vector"},
    {cellmirror::word(InverseClass::align_xy_a_axis), "position in xy and the a vector"},
    {cellmirror::word(InverseClass::align_xz_n_axis), "position in xz and the n vector"},
    {cellmirror::word(InverseClass::align_xz_s_axis), "position in xz and the s vector"},
    {cellmirror::word(InverseClass::align_xz_a_axis), "position in xz and the a vector"},
    {cellmirror::word(InverseClass::align_yz_n_axis), "position in yz and the n vector"},
    {cellmirror::word(InverseClass::align_yz_s_axis), "position in yz and the s vector"},
    {cellmirror::word(InverseClass::align_yz_a_axis), "position in yz and the a vector"},
    {cellmirror::word(InverseClass::edith), "redundant boom in the horizontal plane, all joints evenly bent"},
    {cellmirror::word(InverseClass::boom_3),
     "as EDITH, but only the last 3 joints evenly bent, the others near their present values"},
    {cellmirror::word(InverseClass::boom_4), "the same with the last 4 joints"},
    {cellmirror::word(InverseClass::boom_5), "the same with the last 5 joints"},
    {cellmirror::word(InverseClass::boom_6), "the same with the last 6 joints"},
};

constexpr Parameter kLinearVelocity[] = {number("lin_vel", "velocity", Unit::mm_per_s, kPositive)};
constexpr Parameter kLinearAcceleration[] = {number("lin_acc", "acceleration", Unit::mm_per_s2, kPositive)};
constexpr Parameter kAngularVelocity[] = {number("ang_vel", "angular velocity", Unit::degree_per_s, kPositive)};
constexpr Parameter kAngularAcceleration[] = {
    number("ang_acc", "angular acceleration", Unit::degree_per_s2, kPositive)};
constexpr Parameter kVelocityScale[] = {number("scale", "velocity scale", Unit::none, kScale)};
constexpr Parameter kAccelerationScale[] = {number("scale", "acceleration scale", Unit::none, kScale)};
constexpr Parameter kFly[] = {integer("fly_type", "fly type", {0, 2}),
                              number("fly_parameter", "fly parameter", Unit::by_fly_type, kNotNegative)};
constexpr Parameter kDelay[] = {number("delay", "delay", Unit::second, kNotNegative)};
constexpr Parameter kMaxRange[] = {joints("upper limit", Unit::joint_position)};
constexpr Parameter kMinRange[] = {joints("lower limit", Unit::joint_position)};
constexpr Parameter kStart[] = {joints("start position", Unit::joint_position)};
constexpr Parameter kReference[] = {joints("reference position", Unit::joint_position)};
constexpr Parameter kMaxVelocity[] = {joints("maximum velocity", Unit::joint_velocity, kPositive)};
constexpr Parameter kMinVelocity[] = {joints("minimum velocity", Unit::joint_velocity, kNotNegative)};
constexpr Parameter kActiveVelocity[] = {joints("velocity", Unit::joint_velocity, kPositive)};
constexpr Parameter kMaxAcceleration[] = {joints("maximum acceleration", Unit::joint_acceleration, kPositive)};
constexpr Parameter kActiveAcceleration[] = {joints("acceleration", Unit::joint_acceleration, kPositive)};
constexpr Parameter kPtp[] = {choice("sync | async", "PTP mode", kPtpModes)};
constexpr Parameter kOffset[] = {number("X", "x", Unit::mm),         number("Y", "y", Unit::mm),
                                 number("Z", "z", Unit::mm),         number("P", "roll", Unit::degree),
                                 number("R", "pitch", Unit::degree), number("Y", "yaw", Unit::degree)};
constexpr Parameter kProfile[] = {choice("sine | ramp", "velocity profile", kProfiles)};
constexpr Parameter kInverse[] = {choice("solution_hint", "inverse kinematics class", kInverseClasses)};
constexpr Parameter kArc[] = {on_off("welding spark")};

constexpr std::string_view kOneForEachJoint = "one value for each joint";
constexpr std::string_view kLimited =
    "one value for each joint; a lower maximum limits it while in force; status shows both";
constexpr std::string_view kStartPosition =
    "one value for each joint; a robot that nothing has moved yet, as in a startup script, is set there at once; later "
    "the position is only the target of MOVE_ROB ... START, and the answer says so";
constexpr std::string_view kForThreeJoints =
    "for a robot with three joints; refused for the robot with six joints of the other examples";
constexpr std::string_view kOffsetOrder = "translation, then roll, pitch, yaw; with or without commas";

constexpr Form joint_form(FormId id, std::string_view name, std::string_view syntax,
                          std::span<const Parameter> parameters, std::string_view help, std::string_view example,
                          std::string_view definition = kOneForEachJoint, std::string_view conflict = {}) {
  return {.id = id,
          .name = name,
          .syntax = syntax,
          .section = kSection,
          .parameters = parameters,
          .help = help,
          .example = example,
          .conflict = conflict,
          .definition = definition,
          .effect = LoopEffect::queued,
          .needs_active_robot = true};
}

constexpr Form scalar_form(FormId id, std::string_view name, std::string_view syntax,
                           std::span<const Parameter> parameters, std::string_view help, std::string_view example) {
  return {.id = id,
          .name = name,
          .syntax = syntax,
          .section = kSection,
          .parameters = parameters,
          .help = help,
          .example = example,
          .effect = LoopEffect::queued,
          .needs_active_robot = true};
}

// The slots by which scripts/commands reads the values.
static_assert(has_slots(kFly, {slots::fly::kType, slots::fly::kParameter}));
static_assert(has_slots(kOffset, {{slots::offset::kTranslation, 0, "X"}, {slots::offset::kRotation, 3, "P"}}));

constexpr Form kForms[] = {
    scalar_form(FormId::rob_cart_lin_vel, "rob_cart_lin_vel", "rob_cart_lin_vel <lin_vel>", kLinearVelocity,
                "sets the maximum velocity in linear moves", "rob_cart_lin_vel 1200.0"),
    scalar_form(FormId::rob_cart_lin_acc, "rob_cart_lin_acc", "rob_cart_lin_acc <lin_acc>", kLinearAcceleration,
                "sets the maximum acceleration in linear moves", "rob_cart_lin_acc 4800.0"),
    scalar_form(FormId::rob_cart_rot_vel, "rob_cart_rot_vel", "rob_cart_rot_vel <ang_vel>", kAngularVelocity,
                "sets the maximum angular velocity of the tool in linear moves", "rob_cart_rot_vel 360.0"),
    scalar_form(FormId::rob_cart_rot_acc, "rob_cart_rot_acc", "rob_cart_rot_acc <ang_acc>", kAngularAcceleration,
                "sets the maximum angular acceleration of the tool in linear moves", "rob_cart_rot_acc 720.0"),
    scalar_form(FormId::rob_cart_vel_scal, "rob_cart_vel_scal", "rob_cart_vel_scal <scale>", kVelocityScale,
                "scales linear and angular velocity in linear moves", "rob_cart_vel_scal 0.3"),
    scalar_form(FormId::rob_cart_acc_scal, "rob_cart_acc_scal", "rob_cart_acc_scal <scale>", kAccelerationScale,
                "scales the acceleration in linear moves", "rob_cart_acc_scal 0.65"),
    scalar_form(FormId::rob_cart_fly_radius, "rob_cart_fly_radius", "rob_cart_fly_radius <fly_type> <fly_parameter>",
                kFly,
                "sets the fly point of linear moves: 0 below a fraction of the velocity, 1 within a distance, 2 within "
                "an angle",
                "rob_cart_fly_radius 1 5.0"),
    scalar_form(FormId::rob_program_delays, "rob_program_delays", "rob_program_delays <delay>", kDelay,
                "sets the delay between TF_RUN and the start of a program", ""),
    joint_form(FormId::rob_jnt_max_range, "rob_jnt_max_range", "rob_jnt_max_range <n values>", kMaxRange,
               "sets the upper limits of the joints", "rob_jnt_max_range 162.5 110.0 145.0 187.5 115.5 270.0"),
    joint_form(FormId::rob_jnt_min_range, "rob_jnt_min_range", "rob_jnt_min_range <n values>", kMinRange,
               "sets the lower limits of the joints", "rob_jnt_min_range -162.5 -110.0 -145.0 -187.5 -115.5 -270.0"),
    joint_form(FormId::rob_jnt_start_pos, "rob_jnt_start_pos", "rob_jnt_start_pos <n values>", kStart,
               "sets the position at the start of the simulation",
               "rob_jnt_start_pos 0.0 50.0 -110.0 0.0 -150.0 -180.0", kStartPosition,
               "-150 degrees of joint 5 contradict the -115.5 in the example of rob_jnt_min_range"),
    joint_form(FormId::rob_jnt_ref_pos, "rob_jnt_ref_pos", "rob_jnt_ref_pos <n values>", kReference,
               "sets the controller's reference position", "rob_jnt_ref_pos 17.35 0 -12.79307 1.507E-03 0.0 15.2003"),
    joint_form(FormId::rob_jnt_max_vel, "rob_jnt_max_vel", "rob_jnt_max_vel <n values>", kMaxVelocity,
               "sets the maximum velocities of the joints",
               "rob_jnt_max_vel 1.919862 1.483553 5.235988 3.14159 4.014257 3.926991"),
    joint_form(FormId::rob_jnt_min_vel, "rob_jnt_min_vel", "rob_jnt_min_vel <n values>", kMinVelocity,
               "sets the minimum velocities of the joints (stepper motors)",
               "rob_jnt_min_vel 8.5 3.14159E-04 4.014257E-04", kOneForEachJoint, kForThreeJoints),
    joint_form(FormId::rob_jnt_act_vel, "rob_jnt_act_vel", "rob_jnt_act_vel <n values>", kActiveVelocity,
               "sets the velocities in force until a program sets others", "rob_jnt_act_vel 1300.0 3.14159 1.5707963",
               kLimited, kForThreeJoints),
    joint_form(FormId::rob_jnt_max_acc, "rob_jnt_max_acc", "rob_jnt_max_acc <n values>", kMaxAcceleration,
               "sets the maximum accelerations of the joints",
               "rob_jnt_max_acc 1.919862 1.483553 5.235988 3.14159 4.014257 3.926991"),
    joint_form(FormId::rob_jnt_act_acc, "rob_jnt_act_acc", "rob_jnt_act_acc <n values>", kActiveAcceleration,
               "sets the accelerations in force until a program sets others",
               "rob_jnt_act_acc 1.919862 1.483553 5.235988 3.14159 4.014257 3.926991", kLimited),
    scalar_form(FormId::rob_ptp_mode, "rob_PTPmode", "rob_PTPmode [sync | async]", kPtp,
                "sets whether the axes of a point-to-point move end together or each at its own time",
                "rob_PTPmode sync"),
    {.id = FormId::rob_por_def,
     .name = "rob_por_def",
     .syntax = "rob_por_def <X Y Z P R Y>",
     .section = kSection,
     .parameters = kOffset,
     .help = "sets the offset of the point of reference",
     .example = "rob_por_def 418.0 0.0 -78.0 90.0 -45.0 0.0",
     .definition = kOffsetOrder,
     .effect = LoopEffect::queued,
     .needs_active_robot = true,
     .commas = true},
    {.id = FormId::rob_tcp_def,
     .name = "rob_tcp_def",
     .syntax = "rob_tcp_def <X Y Z P R Y>",
     .section = kSection,
     .parameters = kOffset,
     .help = "sets the offset of the tool centre point",
     .example = "rob_tcp_def 83.0 -170.0 0.0 -90.0 0.0 -30.0",
     .definition = kOffsetOrder,
     .effect = LoopEffect::queued,
     .needs_active_robot = true,
     .commas = true},
    scalar_form(FormId::rob_vel_profile, "rob_vel_profile", "rob_vel_profile [sine | ramp]", kProfile,
                "sets the shape of the velocity profile", "rob_vel_profile ramp"),
    scalar_form(FormId::rob_inverse_class, "rob_inverse_class", "rob_inverse_class <solution_hint>", kInverse,
                "sets the part of a pose that inverse kinematics must meet, and the resolution of redundancy",
                "rob_inverse_class align_POS"),
    {.id = FormId::arc,
     .name = "ARC",
     .syntax = "ARC [on | off]",
     .section = kSection,
     .parameters = kArc,
     .help = "shows or hides a welding spark at the active robot's TCP",
     .example = "ARC on",
     .needs_active_robot = true},
};

}  // namespace

std::span<const Form> robot_parameter_forms() { return kForms; }

}  // namespace cellmirror::script
