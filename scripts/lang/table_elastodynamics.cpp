// Manual 1.2.5: elastodynamic objects. The tables A.1, A.4 and A.5 that it refers to are ours.
#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <string>

#include "rt_core/ports/tissue_settings.hpp"
#include "scripts/lang/slots.hpp"
#include "scripts/lang/table_parts.hpp"
#include "scripts/lang/values.hpp"

namespace cellmirror::script {

namespace {

using namespace parts;

constexpr std::string_view kSection = "1.2.5";
// The words and bits are those of the simulation; here is what they mean and the units in which SCRIPT gives values.
constexpr std::array<std::string_view, kTissueAttributeWords.size()> kAttributeMeanings = {
    "it is simulated, else it keeps its shape",
    "instruments touch it",
    "grippers hold it",
    "clips can be put on it",
    "scissors and a hot hook divide it",
    "heat changes it",
    "it tears beyond the strain limit of its material",
    "it yields beyond the strain limit of its material",
    "it touches rigid bodies of the cell and other objects",
    "it has weight",
    "it is drawn",
    "it is drawn with wet highlights",
};

constexpr std::array<std::string_view, kTissueLimitActionWords.size()> kActionMeanings = {
    "the excess is only counted, as every excess is",
    "the value is held at the limit",
    "the instrument has no effect in this step",
    "what the instrument holds is released",
    "the object keeps its shape, until eladyn_model_reset or CALCULATE on",
    "an event in the log and on the SENSOR channel",
};

struct LimitMeaning {
  Unit unit;
  std::string_view meaning;
};
constexpr std::array<LimitMeaning, kTissueLimitWords.size()> kLimitMeanings = {{
    {Unit::mm_per_s, "of an instrument's tip from one step to the next"},
    {Unit::mm, "of an instrument into a surface"},
    {Unit::newton, "on an instrument"},
    {Unit::newton, "at a held point"},
    {Unit::mm_per_s, "of a node of an object"},
    {Unit::none, "stretch of an element, less 1"},
}};

// Bit i belongs to word i.
template <std::size_t N>
constexpr std::array<Attribute, N> bits_of(const std::array<std::string_view, N>& words,
                                           const std::array<std::string_view, N>& meanings) {
  std::array<Attribute, N> rows{};
  for (std::size_t i = 0; i < N; ++i) rows[i] = {words[i], 1U << i, meanings[i]};
  return rows;
}

template <std::size_t N>
constexpr std::array<PlausibilityToken, N> tokens_of(const std::array<std::string_view, N>& words,
                                                     const std::array<LimitMeaning, N>& meanings) {
  std::array<PlausibilityToken, N> rows{};
  for (std::size_t i = 0; i < N; ++i)
    rows[i] = {words[i], meanings[i].unit, meanings[i].meaning, kDefaultTissueLimits[i]};
  return rows;
}

constexpr auto kAttributes = bits_of(kTissueAttributeWords, kAttributeMeanings);
constexpr auto kFlags = bits_of(kTissueLimitActionWords, kActionMeanings);
constexpr auto kTokens = tokens_of(kTissueLimitWords, kLimitMeanings);

constexpr Range kAttributeFlags{0.0, kAllTissueAttributes, false, false};
constexpr Range kActionFlags{0.0, (1U << kTissueLimitActionWords.size()) - 1U, false, false};

template <class Row, std::size_t N>
constexpr std::array<Choice, N> choices_of(const std::array<Row, N>& rows) {
  std::array<Choice, N> choices{};
  for (std::size_t i = 0; i < N; ++i) choices[i] = {rows[i].token, rows[i].meaning};
  return choices;
}

constexpr auto kAttributeChoices = choices_of(kAttributes);
constexpr auto kTokenChoices = choices_of(kTokens);

constexpr Parameter object() { return identifier("geo_name | ALL", "deformable object"); }

constexpr Parameter kGeoFlags[] = {object(), integer("flags", "attribute flags (table A.1)", kAttributeFlags),
                                   Parameter{.name = "v1 v2 v3 v4",
                                             .meaning = "parameter",
                                             .kind = ParameterKind::number_list,
                                             .width = 4,
                                             .optional = true}};
constexpr Parameter kGeoToken[] = {object(), choice("token", "attribute (table A.1)", kAttributeChoices), on_off()};
constexpr Parameter kHyper[] = {file("hyper_file", "file of interconnections")};
constexpr Parameter kShow[] = {choice("0 | 1", "switch", kZeroOne)};
constexpr Parameter kPlausibility[] = {choice("token", "plausibility token (table A.5)", kTokenChoices),
                                       integer("flags", "plausibility flags (table A.4)", kActionFlags),
                                       number("val", "limit", Unit::by_plausibility, kNotNegative)};
constexpr Parameter kPulse[] = {word("PULSE"), choice("ON | OFF", "switch", kOnOff)};
constexpr Parameter kBleeding[] = {word("BLEEDING"), choice("ON | OFF", "switch", kOnOff)};
constexpr Parameter kRipples[] = {word("POOL_RIPPLES"), choice("ON | OFF", "switch", kOnOff)};
constexpr Parameter kResetPool[] = {word("RESET_POOL")};
constexpr Parameter kCleanLense[] = {word("CLEAN_ENDOSCOPIC_LENSE")};

// The slots by which scripts/commands reads the values.
static_assert(has_slots(kGeoFlags, {slots::tissue_attributes::kObject, slots::tissue_attributes::kFlags}));
static_assert(has_slots(kGeoToken, {slots::tissue_attribute::kObject, slots::tissue_attribute::kToken,
                                    slots::tissue_attribute::kOn}));
static_assert(has_slots(kPlausibility,
                        {slots::tissue_limit::kToken, slots::tissue_limit::kFlags, slots::tissue_limit::kValue}));

constexpr Form kForms[] = {
    {.id = FormId::eladyn_geo_def_flags,
     .name = "eladyn_geo_def",
     .syntax = "eladyn_geo_def [<geo_name> | ALL] <flags> {v1 v2 v3 v4}",
     .section = kSection,
     .parameters = kGeoFlags,
     .help = "sets the attributes of one deformable object or of all by flags",
     .definition =
         "attributes with their bit in flags are on, all others off (table A.1); 0 to 4 values, without effect as in "
         "the manual; with four values, a name that does not end in .mpo means the cylinders of an effector (1.2.6)",
     .selector = Selector::by_shape},
    {.id = FormId::eladyn_geo_def_token,
     .name = "eladyn_geo_def",
     .syntax = "eladyn_geo_def [<geo_name> | ALL] <token> [on | off]",
     .section = kSection,
     .parameters = kGeoToken,
     .help = "switches one attribute of one deformable object or of all",
     .definition = "the other attributes stay",
     .selector = Selector::by_shape},
    {.id = FormId::eladyn_hyper_name,
     .name = "eladyn_hyper_name",
     .syntax = "eladyn_hyper_name <hyper_file>",
     .section = kSection,
     .parameters = kHyper,
     .help = "loads the file of the interconnections between deformable objects",
     .definition =
         "a file of envlib; its connections replace all present ones, also torn ones; a faulty file changes nothing"},
    {.id = FormId::eladyn_show_def,
     .name = "eladyn_show_def",
     .syntax = "eladyn_show_def [0 | 1]",
     .section = kSection,
     .parameters = kShow,
     .help = "shows or hides the nodes and springs of deformable objects",
     .definition = "off at the start"},
    {.id = FormId::eladyn_model_reset,
     .name = "eladyn_model_reset",
     .syntax = "eladyn_model_reset",
     .section = kSection,
     .help = "resets all deformable objects and interconnections",
     .definition = "restores shape, cuts, clips, burns, connections and the pool, and ends FREEZE (table A.4); "
                   "attributes, limits, effects and instruments stay as commands have set them"},
    {.id = FormId::eladyn_plaus_param,
     .name = "eladyn_plaus_param",
     .syntax = "eladyn_plaus_param <token> <flags> <val>",
     .section = kSection,
     .parameters = kPlausibility,
     .help = "sets a limit of the plausibility test of interactions",
     .definition = "table A.4 has the flags, table A.5 the tokens with unit and initial limit; flags or a value of 0 "
                   "turn the limit off"},
    {.id = FormId::effects_pulse,
     .name = "EFFECTS",
     .syntax = "EFFECTS PULSE [ON | OFF]",
     .section = kSection,
     .parameters = kPulse,
     .help = "switches the wave of blood pressure in arteries",
     .definition = "off at the start, as all effects",
     .selector = Selector::by_first_word},
    {.id = FormId::effects_bleeding,
     .name = "EFFECTS",
     .syntax = "EFFECTS BLEEDING [ON | OFF]",
     .section = kSection,
     .parameters = kBleeding,
     .help = "switches the bleeding of cut vessels",
     .selector = Selector::by_first_word},
    {.id = FormId::effects_pool_ripples,
     .name = "EFFECTS",
     .syntax = "EFFECTS POOL_RIPPLES [ON | OFF]",
     .section = kSection,
     .parameters = kRipples,
     .help = "switches ripples on the pool of fluid",
     .selector = Selector::by_first_word},
    {.id = FormId::effects_reset_pool,
     .name = "EFFECTS",
     .syntax = "EFFECTS RESET_POOL",
     .section = kSection,
     .parameters = kResetPool,
     .help = "resets colour, transparency and height of the fluid",
     .selector = Selector::by_first_word},
    {.id = FormId::effects_clean_endoscopic_lense,
     .name = "EFFECTS",
     .syntax = "EFFECTS CLEAN_ENDOSCOPIC_LENSE",
     .section = kSection,
     .parameters = kCleanLense,
     .help = "clears the lens of the endoscope's camera",
     .selector = Selector::by_first_word},
};

}  // namespace

std::span<const Attribute> object_attributes() { return kAttributes; }
std::span<const Attribute> plausibility_flags() { return kFlags; }
std::span<const PlausibilityToken> plausibility_tokens() { return kTokens; }

std::string start_text(const PlausibilityToken& token) {
  if (token.start.actions == 0) return "off";
  std::string text = fmt::format("{:g}", token.start.value / to_si(1, token.unit));
  if (token.unit != Unit::none) text += fmt::format(" {}", unit_text(token.unit));
  text += ",";
  for (const Attribute& action : kFlags) {
    if ((token.start.actions & action.bit) != 0) text += fmt::format(" {}", action.token);
  }
  return text;
}

std::span<const Form> elastodynamic_forms() { return kForms; }

}  // namespace cellmirror::script
