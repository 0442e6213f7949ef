// Manual 1.2.7: voxel volumes.
#include "scripts/lang/table_parts.hpp"

namespace cellmirror::script {

namespace {

using namespace parts;

constexpr std::string_view kSection = "1.2.7";
constexpr std::string_view kVolumes = "voxel volumes";

constexpr Range kRightAngle{-90, 90};
constexpr Range kFraction{0, 1};

constexpr Choice kPlanes[] = {{"CLP1", ""}, {"CLP2", ""}, {"CLP3", ""}, {"CLP4", ""}, {"CLP5", ""}, {"CLP6", ""}};
constexpr Choice kPlaneModes[] = {
    {"active", "clips"}, {"reverse", "clips the other side"}, {"visible", "drawn"}, {"off", "neither"}};
constexpr Choice kTables[] = {{"MEDICAL_LUT", "by CT grey value"}, {"LIN_LUT", "linear"},   {"EXP_LUT", "exponential"},
                              {"RAINBOW_LUT", "rainbow"},          {"USER1_LUT", "user's"}, {"USER2_LUT", "user's"}};
constexpr Choice kOtherTables[] = {{"LIN_LUT", "linear"},
                                   {"EXP_LUT", "exponential"},
                                   {"RAINBOW_LUT", "rainbow"},
                                   {"USER1_LUT", "user's"},
                                   {"USER2_LUT", "user's"}};

constexpr Parameter kClip[] = {choice("plane", "clipping plane", kPlanes),
                               choice("active | reverse | visible | off", "mode", kPlaneModes)};
constexpr Parameter kClipPosition[] = {
    choice("plane", "clipping plane", kPlanes),
    labelled("ELE", number("elevation", "elevation", Unit::degree, kRightAngle)),
    labelled("AZI", number("azimuth", "azimuth", Unit::degree, kRightAngle)),
    labelled("DIST", number("distance", "distance", Unit::mm)),
};
constexpr Parameter kTable[] = {choice("LUT_name", "look-up table", kTables)};
constexpr Parameter kMedical[] = {word("MEDICAL_LUT"), number("air", "visibility of air", Unit::none, kFraction),
                                  number("fat", "visibility of fat", Unit::none, kFraction),
                                  number("tissue", "visibility of tissue", Unit::none, kFraction),
                                  number("bone", "visibility of bone", Unit::none, kFraction)};
constexpr Parameter kOther[] = {
    choice("LUT_name", "look-up table", kOtherTables), number("opacity", "opacity", Unit::none, {0, 3}),
    number("gain", "gain", Unit::none, {0, 20}), number("level", "level", Unit::none, {1, 3}),
    number("window", "window", Unit::none, {0, 1.57})};

constexpr Form kForms[] = {
    {.id = FormId::vv_clip,
     .name = "VV_CLIP",
     .syntax = "VV_CLIP <plane> [active | reverse | visible | off]",
     .section = kSection,
     .parameters = kClip,
     .help = "sets the mode of a clipping plane of the volume",
     .missing = kVolumes},
    {.id = FormId::vv_clip_pos,
     .name = "VV_CLIP_POS",
     .syntax = "VV_CLIP_POS <plane> ELE <elevation> AZI <azimuth> DIST <distance>",
     .section = kSection,
     .parameters = kClipPosition,
     .help = "sets the position of a clipping plane in the volume's frame",
     .missing = kVolumes,
     .definition = "the three groups come in any order"},
    {.id = FormId::vv_set_lut,
     .name = "VV_SET_LUT",
     .syntax = "VV_SET_LUT <LUT_name>",
     .section = kSection,
     .parameters = kTable,
     .help = "sets the active colour look-up table",
     .missing = kVolumes},
    {.id = FormId::vv_set_lut_par_medical,
     .name = "VV_SET_LUT_PAR",
     .syntax = "VV_SET_LUT_PAR MEDICAL_LUT <air> <fat> <tissue> <bone>",
     .section = kSection,
     .parameters = kMedical,
     .help = "sets the visibility of each type of tissue in the medical table",
     .missing = kVolumes,
     .selector = Selector::by_first_word},
    {.id = FormId::vv_set_lut_par,
     .name = "VV_SET_LUT_PAR",
     .syntax = "VV_SET_LUT_PAR <LUT_name> <opacity> <gain> <level> <window>",
     .section = kSection,
     .parameters = kOther,
     .help = "sets the parameters of another table",
     .missing = kVolumes,
     .selector = Selector::by_first_word},
    {.id = FormId::vv_reload_luts,
     .name = "VV_RELOAD_LUTS",
     .syntax = "VV_RELOAD_LUTS",
     .section = kSection,
     .help = "reloads all look-up tables",
     .missing = kVolumes},
};

}  // namespace

std::span<const Form> volume_forms() { return kForms; }

}  // namespace cellmirror::script
