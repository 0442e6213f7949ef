// Manual 1.2.5: elastodynamic objects. The tables A.1, A.4 and A.5 that it refers to are ours.
#include <array>
#include <cstddef>

#include "scripts/lang/table_parts.hpp"

namespace cellmirror::script {

namespace {

using namespace parts;

constexpr std::string_view kSection = "1.2.5";
constexpr std::string_view kTissue = "deformable objects";

constexpr Attribute kAttributes[] = {
    {"VISIBLE", 1U << 0, "drawn"},
    {"SIMULATED", 1U << 1, "takes part in the elastodynamic calculation"},
    {"CONTACT", 1U << 2, "tested for contact with instruments"},
    {"SELF_CONTACT", 1U << 3, "tested for contact with itself"},
    {"GRIPPABLE", 1U << 4, "a gripper can hold it"},
    {"CUTTABLE", 1U << 5, "scissors can cut it"},
    {"CLIPPABLE", 1U << 6, "a clip can be set on it"},
    {"COAGULABLE", 1U << 7, "heat coagulates it"},
    {"BLEEDING", 1U << 8, "bleeds when cut"},
    {"PULSE", 1U << 9, "the blood pressure wave acts on its nodes"},
    {"GRAVITY", 1U << 10, "gravity acts on its nodes"},
    {"FIXED_RIM", 1U << 11, "the nodes of its rim do not move"},
};

constexpr Attribute kFlags[] = {
    {"LIMIT", 1U << 0, "the value is limited"},
    {"REJECT", 1U << 1, "the interaction is refused"},
    {"RELEASE", 1U << 2, "the instrument loses the object"},
    {"WARN", 1U << 3, "a warning is shown"},
};

constexpr PlausibilityToken kTokens[] = {
    {"NODE_DISPLACEMENT", Unit::mm, "of one node within one step"},
    {"NODE_VELOCITY", Unit::mm_per_s, "of one node"},
    {"NODE_FORCE", Unit::newton, "on one node"},
    {"SPRING_STRETCH", Unit::none, "length of a spring by its length at rest"},
    {"CONTACT_DEPTH", Unit::mm, "of an instrument within an object"},
    {"CONTACT_FORCE", Unit::newton, "between an instrument and an object"},
};

template <std::size_t N, class Row>
constexpr std::array<Choice, N> choices_of(const Row (&rows)[N]) {
  std::array<Choice, N> choices{};
  for (std::size_t i = 0; i < N; ++i) choices[i] = {rows[i].token, rows[i].meaning};
  return choices;
}

constexpr auto kAttributeChoices = choices_of(kAttributes);
constexpr auto kTokenChoices = choices_of(kTokens);

constexpr Parameter object() { return identifier("geo_name | ALL", "deformable object"); }

constexpr Parameter kGeoFlags[] = {object(), integer("flags", "attribute flags (table A.1)", kUnsigned),
                                   Parameter{.name = "v1 v2 v3 v4",
                                             .meaning = "parameter",
                                             .kind = ParameterKind::number_list,
                                             .width = 4,
                                             .optional = true}};
constexpr Parameter kGeoToken[] = {object(), choice("token", "attribute (table A.1)", kAttributeChoices), on_off()};
constexpr Parameter kHyper[] = {file("hyper_file", "file of interconnections")};
constexpr Parameter kShow[] = {choice("0 | 1", "switch", kZeroOne)};
constexpr Parameter kPlausibility[] = {choice("token", "plausibility token (table A.5)", kTokenChoices),
                                       integer("flags", "plausibility flags (table A.4)", kUnsigned),
                                       number("val", "limit", Unit::by_plausibility, kNotNegative)};
constexpr Parameter kPulse[] = {word("PULSE"), choice("ON | OFF", "switch", kOnOff)};
constexpr Parameter kBleeding[] = {word("BLEEDING"), choice("ON | OFF", "switch", kOnOff)};
constexpr Parameter kRipples[] = {word("POOL_RIPPLES"), choice("ON | OFF", "switch", kOnOff)};
constexpr Parameter kResetPool[] = {word("RESET_POOL")};
constexpr Parameter kCleanLense[] = {word("CLEAN_ENDOSCOPIC_LENSE")};

constexpr Form kForms[] = {
    {.id = FormId::eladyn_geo_def_flags,
     .name = "eladyn_geo_def",
     .syntax = "eladyn_geo_def [<geo_name> | ALL] <flags> {v1 v2 v3 v4}",
     .section = kSection,
     .parameters = kGeoFlags,
     .help = "sets the attributes of one deformable object or of all by flags",
     .missing = kTissue,
     .definition = "0 to 4 values; with four values the object must be ALL or a name that ends in .mpo, else the "
                   "command means the cylinders of an effector (1.2.6)",
     .selector = Selector::by_shape},
    {.id = FormId::eladyn_geo_def_token,
     .name = "eladyn_geo_def",
     .syntax = "eladyn_geo_def [<geo_name> | ALL] <token> [on | off]",
     .section = kSection,
     .parameters = kGeoToken,
     .help = "switches one attribute of one deformable object or of all",
     .missing = kTissue,
     .selector = Selector::by_shape},
    {.id = FormId::eladyn_hyper_name,
     .name = "eladyn_hyper_name",
     .syntax = "eladyn_hyper_name <hyper_file>",
     .section = kSection,
     .parameters = kHyper,
     .help = "names the file of the interconnections between deformable objects",
     .missing = kTissue},
    {.id = FormId::eladyn_show_def,
     .name = "eladyn_show_def",
     .syntax = "eladyn_show_def [0 | 1]",
     .section = kSection,
     .parameters = kShow,
     .help = "shows or hides the nodes and springs of deformable objects",
     .missing = kTissue},
    {.id = FormId::eladyn_model_reset,
     .name = "eladyn_model_reset",
     .syntax = "eladyn_model_reset",
     .section = kSection,
     .help = "resets all deformable objects and interconnections",
     .missing = kTissue},
    {.id = FormId::eladyn_plaus_param,
     .name = "eladyn_plaus_param",
     .syntax = "eladyn_plaus_param <token> <flags> <val>",
     .section = kSection,
     .parameters = kPlausibility,
     .help = "sets a limit of the plausibility test of interactions",
     .missing = kTissue,
     .definition = "the token defines the unit of the limit (table A.5)"},
    {.id = FormId::effects_pulse,
     .name = "EFFECTS",
     .syntax = "EFFECTS PULSE [ON | OFF]",
     .section = kSection,
     .parameters = kPulse,
     .help = "switches the wave of blood pressure in arteries",
     .missing = kTissue,
     .selector = Selector::by_first_word},
    {.id = FormId::effects_bleeding,
     .name = "EFFECTS",
     .syntax = "EFFECTS BLEEDING [ON | OFF]",
     .section = kSection,
     .parameters = kBleeding,
     .help = "switches the bleeding of cut vessels",
     .missing = kTissue,
     .selector = Selector::by_first_word},
    {.id = FormId::effects_pool_ripples,
     .name = "EFFECTS",
     .syntax = "EFFECTS POOL_RIPPLES [ON | OFF]",
     .section = kSection,
     .parameters = kRipples,
     .help = "switches ripples on the pool of fluid",
     .missing = kTissue,
     .selector = Selector::by_first_word},
    {.id = FormId::effects_reset_pool,
     .name = "EFFECTS",
     .syntax = "EFFECTS RESET_POOL",
     .section = kSection,
     .parameters = kResetPool,
     .help = "resets colour, transparency and height of the fluid",
     .missing = kTissue,
     .selector = Selector::by_first_word},
    {.id = FormId::effects_clean_endoscopic_lense,
     .name = "EFFECTS",
     .syntax = "EFFECTS CLEAN_ENDOSCOPIC_LENSE",
     .section = kSection,
     .parameters = kCleanLense,
     .help = "clears the lens of the endoscope's camera",
     .missing = kTissue,
     .selector = Selector::by_first_word},
};

}  // namespace

std::span<const Attribute> object_attributes() { return kAttributes; }
std::span<const Attribute> plausibility_flags() { return kFlags; }
std::span<const PlausibilityToken> plausibility_tokens() { return kTokens; }

std::span<const Form> elastodynamic_forms() { return kForms; }

}  // namespace cellmirror::script
