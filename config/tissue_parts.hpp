// Parts of deformable objects (.mpo): material, regions, fixed zones, vessels, pool, attributes. Private to this
// folder.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "config/table_reader.hpp"
#include "config/tissue_setup.hpp"

namespace cellmirror {

// What is not given is as in `material`.
void read_material(TableReader& reader, tissue::Material& material);
[[nodiscard]] std::vector<tissue::Region> read_regions(TableReader& top, const tissue::Material& material);
[[nodiscard]] std::vector<tissue::FixedZone> read_fixed_zones(TableReader& top);
[[nodiscard]] std::vector<tissue::Vessel> read_vessels(TableReader& top);
[[nodiscard]] std::vector<tissue::PoolDescription> read_pools(TableReader& top);
// [attributes]: on and off, words of table A.1.
[[nodiscard]] std::uint16_t read_attributes(TableReader& top);
// r, g, b, a: 0 to 1.
void read_rgba(TableReader& reader, std::array<float, 4>& rgba);

// Parts that are wholly beside the box around the object's surface: a slip of a unit, or of the frame.
void check_places(TableReader& top, const tissue::ObjectDescription& object, const Eigen::AlignedBox3d& box);

}  // namespace cellmirror
