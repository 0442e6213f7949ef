#include "config/volume/dicom_slices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "config/volume/volume_data.hpp"
#include "config/volume/voxel_stream.hpp"

namespace cellmirror {

namespace {

struct Rescale {
  double slope = 1;
  double intercept = 0;
  bool operator==(const Rescale&) const = default;
};

Rescale rescale_of(const SliceHead& head) {
  return head.slope == 0 ? Rescale{1, head.intercept} : Rescale{head.slope, head.intercept};
}

SliceValues values_of(const SliceHead& head) {
  if (head.is_signed) return SliceValues::s16;
  return head.bits_allocated == 8 ? SliceValues::u8 : SliceValues::u16;
}

// Least and largest value that the bits can hold, rescaled.
std::pair<double, double> bounds_of(const SliceHead& head) {
  const double steps = std::pow(2.0, head.bits_stored);
  const Rescale rescale = rescale_of(head);
  const double a = rescale.slope * (head.is_signed ? -steps / 2 : 0) + rescale.intercept;
  const double b = rescale.slope * (head.is_signed ? steps / 2 - 1 : steps - 1) + rescale.intercept;
  return std::minmax(a, b);
}

template <class T>
class Slices {
 public:
  Slices(const std::vector<SliceFile>& files, const SeriesGeometry& geometry, VolumeProcess& process, VoxelGrid& grid,
         Diagnostics& diagnostics)
      : files_(files), geometry_(geometry), process_(process), grid_(grid), diagnostics_(diagnostics) {
    columns_ = files.front().head.columns;
    rows_ = files.front().head.rows;
  }

  // To = T, or a 16-bit type for converted values.
  template <class To>
  bool read(bool convert) {
    const bool sheared = !geometry_.shear.empty();
    std::vector<To> values(grid_.count());
    std::vector<T> slice(convert || sheared ? std::size_t{columns_} * rows_ : 0);
    const std::size_t per_slice = std::size_t{grid_.size[0]} * grid_.size[1];
    for (std::size_t k = 0; k < geometry_.order.size(); ++k) {
      const SliceFile& file = files_[geometry_.order[k]];
      const std::span<To> to = std::span(values).subspan(k * per_slice, per_slice);
      std::span<T> from = slice;
      if constexpr (std::is_same_v<T, To>) {
        if (!convert && !sheared) from = to;
      }
      if (!read_one(file, from)) return false;
      if (from.data() == reinterpret_cast<const T*>(to.data())) continue;
      const Rescale rescale = convert ? rescale_of(file.head) : Rescale{1, 0};
      const Rescale common = convert ? Rescale{grid_.slope, grid_.intercept} : Rescale{1, 0};
      const auto converted = [&](double value) {
        return limited<To>((rescale.slope * value + rescale.intercept - common.intercept) / common.slope);
      };
      if (sheared) {
        place<To>(from, to, geometry_.shear[k], converted);
      } else {
        std::ranges::transform(from, to.begin(), [&](T value) { return converted(value); });
      }
    }
    grid_.values = std::move(values);
    return true;
  }

 private:
  template <class To>
  static To limited(double value) {
    constexpr auto kLeast = static_cast<double>(std::numeric_limits<To>::min());
    constexpr auto kMost = static_cast<double>(std::numeric_limits<To>::max());
    return static_cast<To>(std::clamp(std::round(value), kLeast, kMost));
  }

  bool read_one(const SliceFile& file, std::span<T> to) {
    auto bytes = read_part_of_file(file.path, 0, kLargestSliceFile);
    Result<void> done = bytes
                            ? process_.pixels(*bytes, columns_, rows_, values_of(file.head), std::as_writable_bytes(to))
                            : Result<void>(std::unexpected(bytes.error()));
    if (!done) diagnostics_.error({}, fmt::format("{}: {}", file.name, done.error().what), done.error().remedy);
    return done.has_value();
  }

  // The slice is `shear` beside the normal: bilinear interpolation, and around it the least value of the slice.
  template <class To, class Convert>
  void place(std::span<const T> from, std::span<To> to, const Eigen::Vector2d& shear, const Convert& converted) {
    const Eigen::Vector2d start = sheared_extent(geometry_).first - shear;
    const To outside = converted(static_cast<double>(*std::ranges::min_element(from)));
    for (std::uint32_t j = 0; j < grid_.size[1]; ++j) {
      for (std::uint32_t i = 0; i < grid_.size[0]; ++i) {
        const double x = start.x() + i;
        const double y = start.y() + j;
        To& out = to[std::size_t{j} * grid_.size[0] + i];
        if (x < 0 || y < 0 || x > columns_ - 1.0 || y > rows_ - 1.0) {
          out = outside;
          continue;
        }
        const auto column = std::min(static_cast<std::uint32_t>(x), columns_ - 2);
        const auto row = std::min(static_cast<std::uint32_t>(y), rows_ - 2);
        const double u = x - column;
        const double v = y - row;
        const T* corner = from.data() + std::size_t{row} * columns_ + column;
        const double upper = (1 - u) * corner[0] + u * corner[1];
        const double lower = (1 - u) * corner[columns_] + u * corner[columns_ + 1];
        out = converted((1 - v) * upper + v * lower);
      }
    }
  }

  const std::vector<SliceFile>& files_;
  const SeriesGeometry& geometry_;
  VolumeProcess& process_;
  VoxelGrid& grid_;
  Diagnostics& diagnostics_;
  std::uint32_t columns_ = 0;
  std::uint32_t rows_ = 0;
};

// A slope and an intercept for all slices. True: their values are converted, to 16 bits signed or unsigned.
bool choose_rescale(const std::vector<SliceFile>& files, VoxelGrid& grid, bool& is_signed, Diagnostics& diagnostics) {
  const Rescale first = rescale_of(files.front().head);
  grid.slope = first.slope;
  grid.intercept = first.intercept;
  const auto same = [&](const SliceFile& file) { return rescale_of(file.head) == first; };
  if (std::ranges::all_of(files, same)) return false;
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  double step = 0;
  bool whole = true;
  for (const SliceFile& file : files) {
    const auto [low, high] = bounds_of(file.head);
    const Rescale rescale = rescale_of(file.head);
    least = std::min(least, low);
    most = std::max(most, high);
    step = std::max(step, std::abs(rescale.slope));
    whole = whole && std::abs(rescale.slope) == 1 && rescale.intercept == std::round(rescale.intercept);
  }
  constexpr double kSteps = 65535;
  using S = std::numeric_limits<std::int16_t>;
  grid.slope = std::max(step, (most - least) / kSteps);
  is_signed = grid.slope == 1 && whole && least >= S::min() && most <= S::max();
  grid.intercept = is_signed ? 0 : least;
  if (!whole || grid.slope != 1) {
    diagnostics.warning({}, fmt::format("slope and intercept differ from slice to slice: values are rounded to steps "
                                        "of {:g}",
                                        grid.slope));
  }
  return true;
}

template <class T>
bool read_as(const std::vector<SliceFile>& files, const SeriesGeometry& geometry, VolumeProcess& process,
             VoxelGrid& grid, Diagnostics& diagnostics) {
  bool is_signed = false;
  const bool convert = choose_rescale(files, grid, is_signed, diagnostics);
  Slices<T> slices(files, geometry, process, grid, diagnostics);
  if (!convert) return slices.template read<T>(false);
  return is_signed ? slices.template read<std::int16_t>(true) : slices.template read<std::uint16_t>(true);
}

}  // namespace

ShearedExtent sheared_extent(const SeriesGeometry& geometry) {
  ShearedExtent out;
  if (geometry.shear.empty()) return out;
  Eigen::Vector2d last = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& shear : geometry.shear) {
    out.first = out.first.cwiseMin(shear);
    last = last.cwiseMax(shear);
  }
  for (int axis = 0; axis < 2; ++axis) {
    const double more = std::min(std::ceil(last[axis] - out.first[axis]), static_cast<double>(kMostVoxelsAlong));
    out.more[static_cast<std::size_t>(axis)] = static_cast<std::uint32_t>(more);
  }
  return out;
}

bool read_slices(const std::vector<SliceFile>& files, const SeriesGeometry& geometry, VolumeProcess& process,
                 VoxelGrid& grid, Diagnostics& diagnostics) {
  const SliceHead& first = files.front().head;
  const auto more = sheared_extent(geometry).more;
  const std::array<std::uint64_t, 3> size{std::uint64_t{first.columns} + more[0], std::uint64_t{first.rows} + more[1],
                                          files.size()};
  const SliceValues type = values_of(first);
  if (auto fits = check_voxels(size, type == SliceValues::u8 ? 1 : 2); !fits) {
    diagnostics.error({}, fits.error().what, fits.error().remedy);
    return false;
  }
  for (std::size_t i = 0; i < 3; ++i) grid.size[i] = static_cast<std::uint32_t>(size[i]);
  switch (type) {
    case SliceValues::u8:
      return read_as<std::uint8_t>(files, geometry, process, grid, diagnostics);
    case SliceValues::s16:
      return read_as<std::int16_t>(files, geometry, process, grid, diagnostics);
    case SliceValues::u16:
      return read_as<std::uint16_t>(files, geometry, process, grid, diagnostics);
  }
  return false;
}

}  // namespace cellmirror
