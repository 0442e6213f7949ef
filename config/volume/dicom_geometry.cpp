#include "config/volume/dicom_geometry.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "config/volume/volume_data.hpp"

namespace cellmirror {

namespace {

constexpr std::size_t kNamed = 3;  // of the same kind of error

class GeometryFinder {
 public:
  GeometryFinder(const std::vector<SlicePlace>& slices, SeriesGeometry& out, Diagnostics& diagnostics)
      : slices_(slices), out_(out), diagnostics_(diagnostics) {}

  bool find(std::uint32_t columns, std::uint32_t rows) {
    if (!check_directions()) return false;
    sort();
    if (!check_distances() || !find_shear()) return false;
    if (const auto fits = check_spacing(out_.spacing_m); !fits) return refuse(fits.error().what, fits.error().remedy);
    const SlicePlace& first = at(0);
    const double slices = static_cast<double>(slices_.size());
    out_.X_PV.linear().col(0) = first.row.normalized();
    out_.X_PV.linear().col(1) = normal_.cross(first.row.normalized());
    out_.X_PV.linear().col(2) = normal_;
    out_.X_PV.translation() =
        1e-3 * first.position + 0.5 * (out_.X_PV.linear() * (out_.spacing_m.cwiseProduct(Eigen::Vector3d(
                                                                columns - 1.0, rows - 1.0, slices - 1.0))));
    return true;
  }

 private:
  [[nodiscard]] const SlicePlace& at(std::size_t number) const { return slices_[out_.order[number]]; }
  [[nodiscard]] double along(std::size_t number) const { return normal_.dot(at(number).position); }

  bool refuse(std::string what, std::string remedy = {}) {
    diagnostics_.error({}, std::move(what), std::move(remedy));
    return false;
  }

  bool check_directions() {
    constexpr double kUnit = 1e-3;
    const SlicePlace& first = slices_.front();
    for (const SlicePlace& slice : slices_) {
      if (std::abs(slice.row.norm() - 1) > kUnit || std::abs(slice.column.norm() - 1) > kUnit ||
          std::abs(slice.row.dot(slice.column)) > kUnit)
        return refuse(fmt::format("{}: the directions of its rows and columns are not at right angles", slice.file));
      if ((slice.row - first.row).norm() > kUnit || (slice.column - first.column).norm() > kUnit)
        return refuse(fmt::format("{} has another orientation than {}", slice.file, first.file),
                      "keep parallel slices in the folder");
      constexpr double kSameSpacing = 1e-4;
      if (!(std::abs(slice.row_spacing - first.row_spacing) <= kSameSpacing) ||
          !(std::abs(slice.column_spacing - first.column_spacing) <= kSameSpacing))
        return refuse(fmt::format("{} has another pixel spacing than {}", slice.file, first.file));
    }
    normal_ = first.row.cross(first.column).normalized();
    return true;
  }

  void sort() {
    out_.order.resize(slices_.size());
    std::iota(out_.order.begin(), out_.order.end(), std::size_t{0});
    std::ranges::stable_sort(out_.order, {}, [&](std::size_t i) { return normal_.dot(slices_[i].position); });
  }

  [[nodiscard]] std::string between(std::size_t number) const {
    return fmt::format("{} ({:.3f} mm) and {} ({:.3f} mm)", at(number).file, along(number), at(number + 1).file,
                       along(number + 1));
  }

  // Duplicates first: they make every distance look uneven.
  bool check_distances() {
    std::vector<double> gaps;
    for (std::size_t i = 0; i + 1 < slices_.size(); ++i) gaps.push_back(along(i + 1) - along(i));
    if (!check_duplicates(gaps)) return false;
    std::vector<double> sorted = gaps;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>((sorted.size() - 1) / 2);
    std::ranges::nth_element(sorted, middle);
    return check_gaps(gaps, *middle);
  }

  bool check_duplicates(const std::vector<double>& gaps) {
    constexpr double kSamePlace = 1e-3;  // mm
    const auto twice = std::ranges::count_if(gaps, [](double gap) { return gap < kSamePlace; });
    if (twice == 0) return true;
    std::size_t named = 0;
    for (std::size_t i = 0; i < gaps.size() && named < kNamed; ++i) {
      if (gaps[i] >= kSamePlace) continue;
      ++named;
      refuse(fmt::format("{} and {} are at the same place, {:.3f} mm along the normal", at(i).file, at(i + 1).file,
                         along(i)),
             "keep one acquisition in the folder");
    }
    if (static_cast<std::size_t>(twice) > named)
      refuse(fmt::format("and {} more pairs of slices at the same place", static_cast<std::size_t>(twice) - named));
    return false;
  }

  bool check_gaps(const std::vector<double>& gaps, double usual) {
    constexpr double kUneven = 0.1;
    constexpr double kNoted = 0.01;
    constexpr double kMissing = 1.5;
    std::size_t wrong = 0;
    double worst = 0;
    for (std::size_t i = 0; i < gaps.size(); ++i) {
      worst = std::max(worst, std::abs(gaps[i] - usual));
      if (std::abs(gaps[i] - usual) <= kUneven * usual) continue;
      if (++wrong > kNamed) continue;
      if (gaps[i] > kMissing * usual) {
        refuse(fmt::format("slices are missing between {}: about {:.0f}, at a usual distance of {:.3f} mm", between(i),
                           std::round(gaps[i] / usual) - 1, usual),
               "export the whole series");
      } else {
        refuse(fmt::format("the distance between {} is {:.3f} mm, elsewhere {:.3f} mm", between(i), gaps[i], usual),
               "resample the series to even distances");
      }
    }
    if (wrong > kNamed) refuse(fmt::format("and {} more uneven distances", wrong - kNamed));
    if (wrong > 0) return false;
    if (worst > kNoted * usual) {
      diagnostics_.warning({}, fmt::format("distances between slices differ from {:.4f} mm by up to {:.4f} mm: their "
                                           "mean is used",
                                           usual, worst));
    }
    const SlicePlace& first = slices_.front();
    const double mean = (along(slices_.size() - 1) - along(0)) / static_cast<double>(gaps.size());
    out_.spacing_m = 1e-3 * Eigen::Vector3d(first.column_spacing, first.row_spacing, mean);
    return true;
  }

  // First pixels beside the normal through the first one.
  bool find_shear() {
    const std::size_t last = slices_.size() - 1;
    const auto beside = [&](std::size_t number) {
      const Eigen::Vector3d from_first = at(number).position - at(0).position;
      return Eigen::Vector2d(from_first.dot(at(0).row) / at(0).column_spacing,
                             from_first.dot(at(0).column) / at(0).row_spacing);
    };
    constexpr double kNoShear = 0.1;      // pixels over the whole series
    constexpr double kOffTheLine = 0.25;  // pixels
    double largest = 0;
    for (std::size_t i = 0; i <= last; ++i) {
      const Eigen::Vector2d wanted = beside(last) * (along(i) - along(0)) / (along(last) - along(0));
      largest = std::max(largest, beside(i).norm());
      if ((beside(i) - wanted).norm() > kOffTheLine)
        return refuse(fmt::format("{} is {:.2f} pixels beside the line through the other slices", at(i).file,
                                  (beside(i) - wanted).norm()),
                      "resample the series: its slices are not one above the other");
    }
    if (largest <= kNoShear) return true;
    const Eigen::Vector3d step = at(last).position - at(0).position;
    out_.tilt_rad = std::atan2((step - normal_ * normal_.dot(step)).norm(), normal_.dot(step));
    for (std::size_t i = 0; i <= last; ++i) out_.shear.push_back(beside(i));
    return true;
  }

  const std::vector<SlicePlace>& slices_;
  SeriesGeometry& out_;
  Diagnostics& diagnostics_;
  Eigen::Vector3d normal_ = Eigen::Vector3d::UnitZ();
};

}  // namespace

bool find_series_geometry(const std::vector<SlicePlace>& slices, std::uint32_t columns, std::uint32_t rows,
                          SeriesGeometry& out, Diagnostics& diagnostics) {
  if (slices.size() < 2) {
    diagnostics.error({}, fmt::format("the series has {} slice, a volume at least 2", slices.size()));
    return false;
  }
  return GeometryFinder(slices, out, diagnostics).find(columns, rows);
}

}  // namespace cellmirror
