// The deformable objects of a cell, as its files describe them, and the largest numbers of what they may name.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/tissue/description/description.hpp"

namespace cellmirror {

inline constexpr std::string_view kObjectExtension = ".mpo";
inline constexpr std::string_view kHyperExtension = ".hyper";

inline constexpr std::size_t kMostObjects = 16;                // of a cell
inline constexpr std::size_t kMostObjectParts = 64;            // regions, fixed zones or vessels of an object
inline constexpr std::size_t kMostVesselPoints = 256;          // of a centre line
inline constexpr std::size_t kMostConnections = 256;           // of a hyper file
inline constexpr std::size_t kMostSurfaceTriangles = 200'000;  // of an object
inline constexpr std::size_t kMostObjectElements = 100'000;    // tetrahedra of an object; far more than a step can hold

inline constexpr std::size_t kLargestObjectFile = std::size_t{1} << 20U;  // bytes of an .mpo or a hyper file

struct TissueSetup {
  std::vector<tissue::ObjectDescription> objects;  // names differ
  std::vector<tissue::Connection> connections;     // at the start, of the hyper file
  std::string hyper_file;                          // its path; empty: none
};

}  // namespace cellmirror
