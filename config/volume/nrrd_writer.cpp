#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <system_error>
#include <variant>
#include <vector>

#include "config/volume/nrrd_file.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace fs = std::filesystem;

namespace {

std::string vector_text(const Eigen::Vector3d& metres) {
  return fmt::format("({},{},{})", 1e3 * metres.x(), 1e3 * metres.y(), 1e3 * metres.z());
}

std::string head_text(const VolumeData& volume, const char* type) {
  const VoxelGrid& grid = volume.grid;
  std::string out = "NRRD0004\n# Written by cellmirror.\n";
  out += fmt::format("type: {}\ndimension: 3\nsizes: {} {} {}\n", type, grid.size[0], grid.size[1], grid.size[2]);
  if (volume.X_PV) {
    Eigen::Vector3d first = grid.spacing_m - 2 * grid.half_extent_m();
    first = *volume.X_PV * Eigen::Vector3d(0.5 * first);
    out += "space: left-posterior-superior\nspace directions:";
    for (int axis = 0; axis < 3; ++axis)
      out += " " + vector_text(volume.X_PV->linear().col(axis) * grid.spacing_m[axis]);
    out += fmt::format("\nspace origin: {}\n", vector_text(first));
  } else {
    const Eigen::Vector3d mm = 1e3 * grid.spacing_m;
    out += fmt::format("spacings: {} {} {}\n", mm.x(), mm.y(), mm.z());
  }
  const char* endian = std::endian::native == std::endian::little ? "little" : "big";
  return out + fmt::format("endian: {}\nencoding: raw\n\n", endian);
}

// Whether all values are integers that 16 bits with sign hold.
bool fits_short(const VoxelGrid& grid) {
  using Short = std::numeric_limits<std::int16_t>;
  if (std::trunc(grid.slope) != grid.slope || std::trunc(grid.intercept) != grid.intercept) return false;
  return std::visit(
      [&](const auto& values) {
        const auto [least, most] = std::ranges::minmax_element(values);
        const double a = grid.slope * *least + grid.intercept;
        const double b = grid.slope * *most + grid.intercept;
        return std::min(a, b) >= Short::min() && std::max(a, b) <= Short::max();
      },
      grid.values);
}

template <class To>
void write_values(const VoxelGrid& grid, std::ofstream& out) {
  const std::size_t per_slice = std::size_t{grid.size[0]} * grid.size[1];
  std::vector<To> slice(per_slice);
  std::visit(
      [&](const auto& values) {
        for (std::size_t at = 0; at < values.size() && out; at += per_slice) {
          std::transform(values.begin() + static_cast<std::ptrdiff_t>(at),
                         values.begin() + static_cast<std::ptrdiff_t>(at + per_slice), slice.begin(),
                         [&](auto stored) { return static_cast<To>(grid.slope * stored + grid.intercept); });
          out.write(reinterpret_cast<const char*>(slice.data()), static_cast<std::streamsize>(sizeof(To) * per_slice));
        }
      },
      grid.values);
}

}  // namespace

Result<void> write_nrrd(const VolumeData& volume, const fs::path& path) {
  const auto cannot = [&](int error) {
    return fail(fmt::format("{} cannot be written: {}", printable(path.string()), std::strerror(error)),
                "name a file in a folder of yours");
  };
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_regular_file(path, error))
    return fail(printable(path.string()) + " exists and is no file", "name another file");
  const bool is_short = fits_short(volume.grid);
  fs::path beside = path;
  beside += ".part";
  {
    errno = 0;
    std::ofstream out(beside, std::ios::binary | std::ios::trunc);
    out << head_text(volume, is_short ? "short" : "float");
    is_short ? write_values<std::int16_t>(volume.grid, out) : write_values<float>(volume.grid, out);
    if (!out.flush()) {
      const int why = errno;
      fs::remove(beside, error);
      return cannot(why);
    }
  }
  fs::rename(beside, path, error);
  return error ? cannot(error.value()) : Result<void>();
}

}  // namespace cellmirror
