// Manual 1.2.4.
#include "scripts/commands/registry.hpp"

namespace cellmirror::script {

namespace {

constexpr Registration kHandlers[] = {
    {FormId::set_force_arrow, not_available},  {FormId::set_torque_limit, not_available},
    {FormId::set_ext_tcp_test, not_available}, {FormId::set_frc_arr_special, not_available},
    {FormId::master_slave, not_available},
};

}  // namespace

std::span<const Registration> dynamics_handlers() { return kHandlers; }

}  // namespace cellmirror::script
