// Manual 1.2.4: commands for the simulation of multibody dynamics.
#include "scripts/lang/parsed_command.hpp"
#include "scripts/lang/slots.hpp"
#include "scripts/lang/table_parts.hpp"

namespace cellmirror::script {

namespace {

using namespace parts;

constexpr std::string_view kSection = "1.2.4";

constexpr Choice kArrows[] = {
    {"0", "none"}, {"1", "x component"}, {"2", "y component"}, {"3", "z component"}, {"4", "resultant"}};

constexpr Parameter kForceArrow[] = {choice("int_1", "arrows of joint forces", kArrows),
                                     choice("int_2", "arrows of joint torques", kArrows),
                                     choice("int_3", "arrow of the TCP force", kArrows)};
constexpr Parameter kTorqueLimit[] = {number("max_force", "force limit", Unit::newton, kNotNegative),
                                      number("max_torque", "torque limit", Unit::newton_metre, kNotNegative)};
// With off alone they may be omitted; the matcher handles that.
constexpr Parameter kTcpTest[] = {on_off("test mode"), optional(number("v1", "force along x", Unit::newton)),
                                  optional(number("v2", "force along y", Unit::newton)),
                                  optional(number("v3", "force along z", Unit::newton)),
                                  optional(number("v4", "torque about the tool axis", Unit::newton_metre))};
constexpr Parameter kSpecial[] = {on_off()};
constexpr Parameter kMasterSlave[] = {on_off("coupling"), robot("master_robot", "master"),
                                      integer("n_slaves", "number of slaves", {1, kMaxSlaves}),
                                      Parameter{.name = "slave_robot n_dof master_joint slave_joint ...",
                                                .meaning = "slaves with their pairs of joints",
                                                .kind = ParameterKind::slaves}};

// The slots by which scripts/commands reads the values.
static_assert(has_slots(kForceArrow, {slots::force_arrow::kJointForces, slots::force_arrow::kJointTorques,
                                      slots::force_arrow::kTcpForce}));
static_assert(has_slots(kTorqueLimit, {slots::torque_limit::kForce, slots::torque_limit::kTorque}));
static_assert(has_slots(kTcpTest, {slots::tcp_test::kOn, slots::tcp_test::kFirstValue}));
static_assert(has_slots(kMasterSlave, {slots::master_slave::kOn, slots::master_slave::kMaster,
                                       slots::master_slave::kSlaves, slots::master_slave::kFirstSlave}));

constexpr Form kForms[] = {
    {.id = FormId::set_force_arrow,
     .name = "SET_FORCE_ARROW",
     .syntax = "SET_FORCE_ARROW <int_1> <int_2> <int_3>",
     .section = kSection,
     .parameters = kForceArrow,
     .help = "sets which components of force arrows are drawn",
     .definition = "initially none"},
    {.id = FormId::set_torque_limit,
     .name = "SET_TORQUE_LIMIT",
     .syntax = "SET_TORQUE_LIMIT <max_force> <max_torque>",
     .section = kSection,
     .parameters = kTorqueLimit,
     .help = "sets limits beyond which forces in shared memory 1313 cause a warning; 0: no limit"},
    {.id = FormId::set_ext_tcp_test,
     .name = "SET_EXT_TCP_TEST",
     .syntax = "SET_EXT_TCP_TEST [on | off] <v1> <v2> <v3> <v4>",
     .section = kSection,
     .parameters = kTcpTest,
     .help = "starts or stops writing test values to shared memory 1313 instead of simulated ones",
     .definition = "force x, y, z [N] and torque about the tool axis [Nm]; off needs no values",
     .effect = LoopEffect::queued},
    {.id = FormId::set_frc_arr_special,
     .name = "SET_FRC_ARR_SPECIAL",
     .syntax = "SET_FRC_ARR_SPECIAL [on | off]",
     .section = kSection,
     .parameters = kSpecial,
     .help = "shows only the force and torque components of the motors, or all"},
    {.id = FormId::master_slave,
     .name = "MASTER_SLAVE",
     .syntax = "MASTER_SLAVE [on | off] <master_robot> <n_slaves> { <slave_robot> <n_dof> { <master_joint> "
               "<slave_joint> } }",
     .section = kSection,
     .parameters = kMasterSlave,
     .help = "couples joints of up to five slaves to joints of a master, or decouples them",
     .definition = "a slave is not its own master, and each of its joints follows one joint only",
     .effect = LoopEffect::queued,
     .commas = true},
};

}  // namespace

std::span<const Form> dynamics_forms() { return kForms; }

}  // namespace cellmirror::script
