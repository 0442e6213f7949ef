// Manual 1.2.5.
#include "scripts/commands/registry.hpp"

namespace cellmirror::script {

namespace {

constexpr Registration kHandlers[] = {
    {FormId::eladyn_geo_def_flags, not_available},
    {FormId::eladyn_geo_def_token, not_available},
    {FormId::eladyn_hyper_name, not_available},
    {FormId::eladyn_show_def, not_available},
    {FormId::eladyn_model_reset, not_available},
    {FormId::eladyn_plaus_param, not_available},
    {FormId::effects_pulse, not_available},
    {FormId::effects_bleeding, not_available},
    {FormId::effects_pool_ripples, not_available},
    {FormId::effects_reset_pool, not_available},
    {FormId::effects_clean_endoscopic_lense, not_available},
};

}  // namespace

std::span<const Registration> elastodynamic_handlers() { return kHandlers; }

}  // namespace cellmirror::script
