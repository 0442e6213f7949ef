// Where the slices of a DICOM series are: order, spacing, gaps and the tilt of the gantry. No files.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/pose.hpp"

namespace cellmirror {

// Of one slice, mm, in the coordinates of the patient (LPS).
struct SlicePlace {
  std::string file;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // of the centre of its first pixel
  Eigen::Vector3d row = Eigen::Vector3d::UnitX();      // unit vector along a row: to the next column
  Eigen::Vector3d column = Eigen::Vector3d::UnitY();
  double row_spacing = 1;     // between rows
  double column_spacing = 1;  // between columns
};

struct SeriesGeometry {
  std::vector<std::size_t> order;  // index of the slices, along row x column
  Eigen::Vector3d spacing_m = Eigen::Vector3d::Constant(1e-3);
  // Of each slice in this order, beside the normal through the first one, pixels along x and y: not zero where the
  // gantry was tilted. Empty: none is.
  std::vector<Eigen::Vector2d> shear;
  double tilt_rad = 0;
  Pose X_PV = Pose::Identity();  // of a volume of columns x rows x slices, before it is made larger by shear
};

// At least 2 slices. Errors: other directions or spacings among them, missing slices, two at a place, uneven distances;
// each with the files between which it is. A warning where distances differ by more than a hundredth.
[[nodiscard]] bool find_series_geometry(const std::vector<SlicePlace>& slices, std::uint32_t columns,
                                        std::uint32_t rows, SeriesGeometry& out, Diagnostics& diagnostics);

}  // namespace cellmirror
