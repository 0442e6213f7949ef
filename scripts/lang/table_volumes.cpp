// Manual 1.2.7: voxel volumes.
#include <array>
#include <cstddef>
#include <string_view>

#include "rt_core/ports/volume_settings.hpp"
#include "scripts/lang/slots.hpp"
#include "scripts/lang/table_parts.hpp"

namespace cellmirror::script {

namespace {

using namespace parts;

constexpr std::string_view kSection = "1.2.7";
constexpr Range kRightAngle{-90, 90};
constexpr Range kFraction{0, 1};

// The words are those of the volume's settings, in their order, by which handlers know them.
constexpr std::array<std::string_view, kVolumeTables> kTableMeanings = {"by CT grey value",
                                                                        "linear",
                                                                        "exponential",
                                                                        "rainbow",
                                                                        "user's, envlib/USER1_LUT.lut",
                                                                        "user's, envlib/USER2_LUT.lut"};

constexpr std::array<Choice, kVolumePlanes> plane_choices() {
  std::array<Choice, kVolumePlanes> choices{};
  for (std::size_t i = 0; i < kVolumePlanes; ++i) choices[i] = {kVolumePlaneWords[i], ""};
  return choices;
}
template <std::size_t kFirst>
constexpr std::array<Choice, kVolumeTables - kFirst> table_choices() {
  std::array<Choice, kVolumeTables - kFirst> choices{};
  for (std::size_t i = kFirst; i < kVolumeTables; ++i) choices[i - kFirst] = {kVolumeTableWords[i], kTableMeanings[i]};
  return choices;
}

constexpr auto kPlanes = plane_choices();
constexpr Choice kPlaneModes[] = {{"active", "hides what lies beyond it"},
                                  {"reverse", "hides what lies before it"},
                                  {"visible", "draws its outline only"},
                                  {"off", "ends both"}};
constexpr auto kTables = table_choices<0>();
constexpr auto kOtherTables = table_choices<1>();

constexpr Parameter kClip[] = {choice("plane", "clipping plane", kPlanes),
                               optional(choice("active | reverse | visible | off", "mode", kPlaneModes), "active"),
                               one_volume()};
constexpr Parameter kClipPosition[] = {
    choice("plane", "clipping plane", kPlanes),
    labelled("ELE", number("elevation", "elevation", Unit::degree, kRightAngle)),
    labelled("AZI", number("azimuth", "azimuth", Unit::degree, kRightAngle)),
    labelled("DIST", number("distance", "distance", Unit::mm)),
    one_volume(),
};
constexpr Parameter kTable[] = {choice("LUT_name", "look-up table", kTables), one_volume()};
constexpr Parameter kMedical[] = {word("MEDICAL_LUT"),
                                  number("air", "visibility of air", Unit::none, kFraction),
                                  number("fat", "visibility of fat", Unit::none, kFraction),
                                  number("tissue", "visibility of tissue", Unit::none, kFraction),
                                  number("bone", "visibility of bone", Unit::none, kFraction),
                                  one_volume()};
constexpr Parameter kOther[] = {choice("LUT_name", "look-up table", kOtherTables),
                                number("opacity", "opacity", Unit::none, {0, kMostVolumeOpacity}),
                                number("gain", "gain", Unit::none, {0, kMostVolumeGain}),
                                number("level", "level", Unit::none, {kLeastVolumeLevel, kMostVolumeLevel}),
                                number("window", "window", Unit::none, {0, kMostVolumeWindow}),
                                one_volume()};
constexpr Parameter kReload[] = {one_volume()};

// The slots by which scripts/commands reads the values.
static_assert(has_slots(kClip,
                        {slots::volume_plane::kPlane, slots::volume_plane::kMode, slots::volume_plane::kVolume}));
static_assert(has_slots(kClipPosition, {slots::volume_plane_position::kPlane, slots::volume_plane_position::kElevation,
                                        slots::volume_plane_position::kAzimuth, slots::volume_plane_position::kDistance,
                                        slots::volume_plane_position::kVolume}));
static_assert(has_slots(kTable, {slots::volume_table::kTable, slots::volume_table::kVolume}));
static_assert(has_slots(kMedical,
                        {slots::medical_table::kAir, slots::medical_table::kFat, slots::medical_table::kTissue,
                         slots::medical_table::kBone, slots::medical_table::kVolume}));
static_assert(has_slots(kOther, {slots::volume_table_parameters::kTable, slots::volume_table_parameters::kOpacity,
                                 slots::volume_table_parameters::kGain, slots::volume_table_parameters::kLevel,
                                 slots::volume_table_parameters::kWindow, slots::volume_table_parameters::kVolume}));
static_assert(has_slots(kReload, {slots::volume_reload::kVolume}));

constexpr Form kForms[] = {
    {.id = FormId::vv_clip,
     .name = "VV_CLIP",
     .syntax = "VV_CLIP <plane> [active | reverse | visible | off]",
     .section = kSection,
     .parameters = kClip,
     .help = "sets the mode of a clipping plane of the volume",
     .definition = "the default mode is active; visible draws the plane's outline within the volume and changes "
                   "nothing else, off ends both; off at the start; a volume may follow, as in all these commands: the "
                   "path of its component; refused in a cell without volumes"},
    {.id = FormId::vv_clip_pos,
     .name = "VV_CLIP_POS",
     .syntax = "VV_CLIP_POS <plane> ELE <elevation> AZI <azimuth> DIST <distance>",
     .section = kSection,
     .parameters = kClipPosition,
     .help = "sets the position of a clipping plane in the volume's frame",
     .definition = "groups in any order; the origin is the middle of the volume; DIST is along the normal (cos ELE cos "
                   "AZI, cos ELE sin AZI, sin ELE); the mode stays"},
    {.id = FormId::vv_set_lut,
     .name = "VV_SET_LUT",
     .syntax = "VV_SET_LUT <LUT_name>",
     .section = kSection,
     .parameters = kTable,
     .help = "sets the active colour look-up table",
     .definition = "each table keeps its parameters; MEDICAL_LUT at the start"},
    {.id = FormId::vv_set_lut_par_medical,
     .name = "VV_SET_LUT_PAR",
     .syntax = "VV_SET_LUT_PAR MEDICAL_LUT <air> <fat> <tissue> <bone>",
     .section = kSection,
     .parameters = kMedical,
     .help = "sets the visibility of each type of tissue in the medical table",
     .definition = "0: not seen, 1: opaque; 0, 0.1, 0.3 and 1 at the start",
     .selector = Selector::by_first_word},
    {.id = FormId::vv_set_lut_par,
     .name = "VV_SET_LUT_PAR",
     .syntax = "VV_SET_LUT_PAR <LUT_name> <opacity> <gain> <level> <window>",
     .section = kSection,
     .parameters = kOther,
     .help = "sets the parameters of another table",
     .definition = "1, 1, 2 and 0.785 at the start (docs/volumes.md); the active table stays",
     .selector = Selector::by_first_word},
    {.id = FormId::vv_reload_luts,
     .name = "VV_RELOAD_LUTS",
     .syntax = "VV_RELOAD_LUTS",
     .section = kSection,
     .parameters = kReload,
     .help = "reloads all look-up tables",
     .definition = "reads the users' tables in the cell folder's envlib again; a faulty file changes nothing"},
};

}  // namespace

std::span<const Form> volume_forms() { return kForms; }

}  // namespace cellmirror::script
