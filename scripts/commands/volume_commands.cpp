// Manual 1.2.7.
#include "scripts/commands/registry.hpp"

namespace cellmirror::script {

namespace {

constexpr Registration kHandlers[] = {
    {FormId::vv_clip, not_available},        {FormId::vv_clip_pos, not_available},
    {FormId::vv_set_lut, not_available},     {FormId::vv_set_lut_par_medical, not_available},
    {FormId::vv_set_lut_par, not_available}, {FormId::vv_reload_luts, not_available},
};

}  // namespace

std::span<const Registration> volume_handlers() { return kHandlers; }

}  // namespace cellmirror::script
