#include "config/tissue_parts.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/tissue_surface.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

// From mucus to tendon, with a margin.
constexpr Range kModulus{10.0, 1e8};
constexpr Range kPoisson{0.0, 0.49};  // towards 0.5 nothing can be compressed, and no explicit step is stable
constexpr Range kDensity{10.0, 20'000.0};
constexpr Range kTissueDamping{0.0, 1.0};
constexpr Range kDrag{0.0, 1000.0};
constexpr Range kStrain{0.0, 10.0};
constexpr Range kTissuePlace{-10.0, 10.0};
constexpr Range kTissueRadius{0.0, 10.0, true};
constexpr Range kPoolSize{0.0, 10.0, true};
constexpr Range kShare{0.0, 1.0};

// Exactly the keys of one of two forms.
bool one_form(TableReader& reader, bool first, bool second, const char* remedy) {
  if (first != second) return true;
  reader.error({}, first ? "two shapes are given" : "no shape is given", remedy);
  return false;
}

std::uint16_t read_words(TableReader& reader, const char* key) {
  std::uint16_t bits = 0;
  const auto words = reader.texts(key);
  if (!words) return bits;
  const std::vector<std::string> known(kTissueAttributeWords.begin(), kTissueAttributeWords.end());
  for (const std::string& word : *words) {
    const auto at = std::ranges::find(known, word);
    if (at != known.end()) {
      bits = static_cast<std::uint16_t>(bits | (1U << static_cast<unsigned>(at - known.begin())));
      continue;
    }
    std::string remedy = did_you_mean(word, known);
    if (remedy.empty()) remedy = fmt::format("the attributes are {}", fmt::join(known, ", "));
    reader.error(key, fmt::format("there is no attribute {}", printable(word)), std::move(remedy));
  }
  return bits;
}

}  // namespace

void read_material(TableReader& reader, tissue::Material& material) {
  const auto read = [&](const char* key, Range range, double& value) {
    value = reader.number(key, range).value_or(value);
  };
  read("youngs_modulus_pa", kModulus, material.youngs_modulus_pa);
  read("poissons_ratio", kPoisson, material.poissons_ratio);
  read("density_kg_m3", kDensity, material.density_kg_m3);
  read("damping_s", kTissueDamping, material.damping_s);
  read("drag_1_s", kDrag, material.drag_1_s);
  read("yield_strain", kStrain, material.yield_strain);
  read("tear_strain", kStrain, material.tear_strain);
}

std::vector<tissue::Region> read_regions(TableReader& top, const tissue::Material& material) {
  std::vector<tissue::Region> regions;
  for (TableReader& reader : top.tables("region", kMostObjectParts)) {
    tissue::Region region;
    region.material = material;
    reader.require("a_m");
    reader.require("radius_m");
    region.name = reader.name("name").value_or("");
    region.a = reader.vector3("a_m", kTissuePlace).value_or(region.a);
    region.b = reader.vector3("b_m", kTissuePlace).value_or(region.a);
    region.radius_m = reader.number("radius_m", kTissueRadius).value_or(1.0);
    read_material(reader, region.material);
    if (const auto rgb = reader.numbers("rgb", 3, kShare)) {
      for (std::size_t i = 0; i < 3; ++i) region.rgb[i] = static_cast<float>((*rgb)[i]);
      region.has_colour = true;
    }
    reader.finish();
    regions.push_back(std::move(region));
  }
  return regions;
}

std::vector<tissue::FixedZone> read_fixed_zones(TableReader& top) {
  std::vector<tissue::FixedZone> zones;
  for (TableReader& reader : top.tables("fixed", kMostObjectParts)) {
    tissue::FixedZone zone;
    const bool box = reader.has("low_m") || reader.has("high_m");
    const bool sphere = reader.has("center_m") || reader.has("radius_m");
    if (one_form(reader, box, sphere, "give low_m and high_m of a box, or center_m and radius_m of a sphere")) {
      for (const char* key : {box ? "low_m" : "center_m", box ? "high_m" : "radius_m"}) reader.require(key);
    }
    const auto low = reader.vector3("low_m", kTissuePlace);
    const auto high = reader.vector3("high_m", kTissuePlace);
    const auto center = reader.vector3("center_m", kTissuePlace);
    const auto radius = reader.number("radius_m", kTissueRadius);
    zone.low = (box ? low : center).value_or(zone.low);
    zone.high = box ? high.value_or(zone.high) : zone.low;
    if (!box) zone.radius_m = radius.value_or(1.0);
    if (low && high && (low->array() > high->array()).any())
      reader.error("high_m", "a coordinate of high_m is below that of low_m", "exchange them");
    reader.finish();
    zones.push_back(zone);
  }
  return zones;
}

std::vector<tissue::Vessel> read_vessels(TableReader& top) {
  std::vector<tissue::Vessel> vessels;
  std::vector<std::string> names;
  for (TableReader& reader : top.tables("vessel", kMostObjectParts)) {
    tissue::Vessel vessel;
    for (const char* key : {"name", "kind", "points_m"}) reader.require(key);
    if (const auto name = reader.name("name")) {
      vessel.name = *name;
      reader.set_where("vessel " + printable(*name));
      if (std::ranges::find(names, *name) != names.end())
        reader.error("name", fmt::format("there is another vessel {}", printable(*name)));
      names.push_back(*name);
    }
    vessel.kind = reader
                      .choice<tissue::VesselKind>("kind", {{"artery", tissue::VesselKind::artery},
                                                           {"vein", tissue::VesselKind::vein},
                                                           {"duct", tissue::VesselKind::duct}})
                      .value_or(vessel.kind);
    vessel.radius_m = reader.number("radius_m", {0.0, 0.1, true}).value_or(vessel.radius_m);
    vessel.centre_line =
        reader.points("points_m", 2, kMostVesselPoints, kTissuePlace).value_or(std::vector<Eigen::Vector3d>());
    for (std::size_t i = 1; i < vessel.centre_line.size(); ++i) {
      if ((vessel.centre_line[i] - vessel.centre_line[i - 1]).norm() >= 1e-6) continue;
      reader.error("points_m", fmt::format("points {} and {} are the same", i, i + 1), "leave one of them out");
    }
    reader.finish();
    vessels.push_back(std::move(vessel));
  }
  return vessels;
}

std::vector<tissue::PoolDescription> read_pools(TableReader& top) {
  auto reader = top.table("pool");
  if (!reader) return {};
  tissue::PoolDescription pool;
  if (const auto size = reader->numbers("size_m", 2, kPoolSize)) pool.size_m = {(*size)[0], (*size)[1]};
  pool.level_m = reader->number("level_m", kTissuePlace).value_or(pool.level_m);
  pool.max_level_m = reader->number("max_level_m", kTissuePlace).value_or(std::max(pool.max_level_m, pool.level_m));
  if (pool.max_level_m < pool.level_m)
    reader->error("max_level_m", "max_level_m is below level_m", "the pool begins at level_m and rises");
  read_rgba(*reader, pool.rgba);
  reader->finish();
  return {pool};
}

std::uint16_t read_attributes(TableReader& top) {
  std::uint16_t attributes = kDefaultTissueAttributes;
  auto reader = top.table("attributes");
  if (!reader) return attributes;
  const std::uint16_t on = read_words(*reader, "on");
  const std::uint16_t off = read_words(*reader, "off");
  if ((on & off) != 0) reader->error("off", "an attribute is both on and off");
  reader->finish();
  return static_cast<std::uint16_t>((attributes | on) & ~off);
}

void read_rgba(TableReader& reader, std::array<float, 4>& rgba) {
  const auto given = reader.numbers("rgba", 4, kShare);
  if (!given) return;
  for (std::size_t i = 0; i < 4; ++i) rgba[i] = static_cast<float>((*given)[i]);
}

void check_places(TableReader& top, const tissue::ObjectDescription& object, const Eigen::AlignedBox3d& box) {
  const std::string remedy =
      fmt::format("the surface reaches from {} to {}", place_text(box.min()), place_text(box.max()));
  const auto grown = [&](double by) { return Eigen::AlignedBox3d(box.min().array() - by, box.max().array() + by); };
  for (std::size_t i = 0; i < object.regions.size(); ++i) {
    const tissue::Region& region = object.regions[i];
    Eigen::AlignedBox3d about(region.a.cwiseMin(region.b), region.a.cwiseMax(region.b));
    if (!about.intersects(grown(region.radius_m)))
      top.error("region", fmt::format("region {} lies beside the object", i + 1), remedy);
  }
  for (std::size_t i = 0; i < object.fixed.size(); ++i) {
    const tissue::FixedZone& zone = object.fixed[i];
    if (!Eigen::AlignedBox3d(zone.low, zone.high).intersects(grown(zone.radius_m)))
      top.error("fixed", fmt::format("fixed zone {} lies beside the object", i + 1), remedy);
  }
  for (const tissue::Vessel& vessel : object.vessels) {
    for (std::size_t i = 0; i < vessel.centre_line.size(); ++i) {
      if (grown(vessel.radius_m).contains(vessel.centre_line[i])) continue;
      top.error("vessel", fmt::format("point {} of vessel {} lies beside the object", i + 1, vessel.name), remedy);
      break;
    }
  }
}

}  // namespace cellmirror
