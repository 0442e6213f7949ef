// Commands that the manual does not have.
#include "scripts/lang/table_parts.hpp"

namespace cellmirror::script {

namespace {

using namespace parts;

constexpr Parameter kFlight[] = {file("file", "flight record")};

constexpr Form kForms[] = {
    {.id = FormId::save_flight,
     .name = "SAVE_FLIGHT",
     .syntax = "SAVE_FLIGHT <file>",
     .section = "ours",
     .parameters = kFlight,
     .help = "writes the flight recorder into the home's records folder",
     .example = "SAVE_FLIGHT before_stop.csv",
     .definition = "a plain file name without folders",
     .origin = Origin::ours},
};

}  // namespace

std::span<const Form> own_forms() { return kForms; }

}  // namespace cellmirror::script
