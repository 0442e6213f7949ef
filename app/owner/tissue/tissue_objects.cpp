#include "app/owner/tissue/tissue_objects.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace {

constexpr std::string_view kExtension = ".mpo";
constexpr std::size_t kListedObjects = 8;  // names in a message

bool has_name(const TissueObject& object, std::string_view name) {
  if (object.name == name) return true;
  return object.name.ends_with(kExtension) &&
         std::string_view(object.name).substr(0, object.name.size() - kExtension.size()) == name;
}

}  // namespace

TissueObject TissueObject::of(const tissue::ObjectDescription& description) {
  TissueObject object{.name = description.name, .attributes = description.attributes};
  object.pool = !description.pools.empty();
  for (const tissue::Vessel& vessel : description.vessels) {
    object.artery = object.artery || vessel.kind == tissue::VesselKind::artery;
    object.blood_vessel = object.blood_vessel || vessel.kind != tissue::VesselKind::duct;
  }
  return object;
}

bool TissueObjects::any(bool TissueObject::* what) const {
  return std::ranges::any_of(objects_, [what](const TissueObject& object) { return object.*what; });
}

bool TissueObjects::means_all(std::string_view name) const { return !empty() && equal_ignoring_case(name, "ALL"); }

Result<std::size_t> TissueObjects::find(std::string_view name) const {
  if (empty()) {
    return fail("the cell has no deformable object", "deformable objects (.mpo files) are placed in the cell file");
  }
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    if (has_name(objects_[i], name)) return i;
  }
  return std::unexpected(unknown(name));
}

Error TissueObjects::unknown(std::string_view name) const {
  std::vector<std::string> names;
  for (const TissueObject& object : objects_) names.push_back(object.name);
  std::string remedy = did_you_mean(name, names);
  if (remedy.empty()) {
    const std::size_t more = names.size() > kListedObjects ? names.size() - kListedObjects : 0;
    names.resize(names.size() - more);
    remedy =
        fmt::format("the cell has {}{}", fmt::join(names, ", "), more == 0 ? "" : fmt::format(" and {} more", more));
  }
  return {fmt::format("there is no deformable object {}", printable(name)), std::move(remedy)};
}

}  // namespace cellmirror::app
