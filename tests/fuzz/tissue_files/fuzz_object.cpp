// Any bytes as a deformable object (.mpo): findings, or an object within its limits. Its meshes are found and empty,
// its tetrahedra are two of a cube.
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "config/tissue_object.hpp"
#include "rt_core/base/contract.hpp"

namespace {

using namespace cellmirror;

class TwoTetrahedra final : public FileFinder {
 public:
  [[nodiscard]] Result<std::filesystem::path> find(FileUse use, std::string_view name) const override {
    return AnyFile().find(use, name);
  }
  [[nodiscard]] Result<std::filesystem::path> find_mesh_of_urdf(const std::filesystem::path& urdf,
                                                                std::string_view name) const override {
    return AnyFile().find_mesh_of_urdf(urdf, name);
  }
  [[nodiscard]] std::optional<tissue::TetraMesh> tetrahedra(const std::filesystem::path&, double scale,
                                                            Diagnostics&) const override {
    tissue::TetraMesh mesh;
    mesh.nodes = {{0, 0, 0}, {scale, 0, 0}, {0, scale, 0}, {0, 0, scale}, {scale, scale, scale}};
    mesh.tetrahedra = {{0, 1, 2, 3}, {1, 2, 3, 4}};
    return mesh;
  }
};

void check_material(const tissue::Material& material) {
  for (const double value : {material.youngs_modulus_pa, material.density_kg_m3})
    CELLMIRROR_EXPECTS(std::isfinite(value) && value > 0);
  for (const double value : {material.damping_s, material.drag_1_s, material.yield_strain, material.tear_strain})
    CELLMIRROR_EXPECTS(std::isfinite(value) && value >= 0);
  CELLMIRROR_EXPECTS(material.poissons_ratio >= 0 && material.poissons_ratio <= 0.49);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kLargest = 64UL << 10U;
  if (size > kLargest) return 0;
  Diagnostics diagnostics;
  const auto object =
      parse_object({reinterpret_cast<const char*>(data), size}, "envlib/fuzz.mpo", TwoTetrahedra(), diagnostics);
  CELLMIRROR_EXPECTS(object.has_value() == diagnostics.ok());
  if (!object) return 0;
  CELLMIRROR_EXPECTS(object->name == "fuzz.mpo");
  check_material(object->material);
  CELLMIRROR_EXPECTS(object->regions.size() <= kMostObjectParts && object->fixed.size() <= kMostObjectParts);
  for (const tissue::Region& region : object->regions) {
    check_material(region.material);
    CELLMIRROR_EXPECTS(region.a.allFinite() && region.b.allFinite() && region.radius_m > 0);
  }
  for (const tissue::FixedZone& zone : object->fixed)
    CELLMIRROR_EXPECTS(zone.radius_m > 0 || (zone.low.array() <= zone.high.array()).all());
  for (const tissue::Vessel& vessel : object->vessels) {
    CELLMIRROR_EXPECTS(vessel.radius_m > 0 && !vessel.name.empty());
    CELLMIRROR_EXPECTS(vessel.centre_line.size() >= 2 && vessel.centre_line.size() <= kMostVesselPoints);
    for (const Eigen::Vector3d& p : vessel.centre_line) CELLMIRROR_EXPECTS(p.allFinite());
  }
  CELLMIRROR_EXPECTS(object->pools.size() <= 1 && object->element_size_m > 0);
  CELLMIRROR_EXPECTS((object->attributes & ~kAllTissueAttributes) == 0);
  return 0;
}
