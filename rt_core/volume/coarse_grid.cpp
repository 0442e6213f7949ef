#include "rt_core/volume/coarse_grid.hpp"

#include <algorithm>
#include <array>
#include <type_traits>

namespace cellmirror::volume {

namespace {

template <class T>
class SliceHalver {
 public:
  SliceHalver(const VoxelGrid& fine, const std::vector<T>& from, VoxelGrid& coarse, std::vector<T>& to)
      : fine_(fine), from_(from), coarse_(coarse), to_(to), sums_(fine.size[0]) {}

  void fill(std::uint32_t k) {
    const std::array<std::uint32_t, 2> z = pair(k, fine_.size[2]);
    for (std::uint32_t j = 0; j < coarse_.size[1]; ++j) {
      const std::array<std::uint32_t, 2> y = pair(j, fine_.size[1]);
      add_rows({row(y[0], z[0]), row(y[1], z[0]), row(y[0], z[1]), row(y[1], z[1])});
      T* const out = to_.data() + std::size_t{coarse_.size[0]} * (j + std::size_t{coarse_.size[1]} * k);
      const std::uint32_t whole = fine_.size[0] / 2;
      for (std::uint32_t i = 0; i < whole; ++i) out[i] = mean(sums_[2 * i] + sums_[2 * i + 1]);
      for (std::uint32_t i = whole; i < coarse_.size[0]; ++i) out[i] = mean(2 * sums_[fine_.size[0] - 1]);
    }
  }

 private:
  static std::array<std::uint32_t, 2> pair(std::uint32_t i, std::uint32_t size) {
    return {std::min(2 * i, size - 1), std::min(2 * i + 1, size - 1)};
  }
  [[nodiscard]] const T* row(std::uint32_t y, std::uint32_t z) const {
    return from_.data() + std::size_t{fine_.size[0]} * (y + std::size_t{fine_.size[1]} * z);
  }
  void add_rows(const std::array<const T*, 4>& rows) {
    std::int32_t* const sums = sums_.data();
    for (std::size_t i = 0; i < sums_.size(); ++i) sums[i] = rows[0][i] + rows[1][i] + rows[2][i] + rows[3][i];
  }
  static T mean(std::int32_t of_eight) { return static_cast<T>((of_eight + 4) >> 3); }

  const VoxelGrid& fine_;
  const std::vector<T>& from_;
  const VoxelGrid& coarse_;
  std::vector<T>& to_;
  std::vector<std::int32_t> sums_;
};

}  // namespace

VoxelGrid coarse_grid_of(const VoxelGrid& fine) {
  VoxelGrid coarse;
  coarse.name = fine.name;
  for (std::size_t axis = 0; axis < 3; ++axis) coarse.size[axis] = std::max(2U, (fine.size[axis] + 1) / 2);
  coarse.spacing_m = 2 * fine.spacing_m;
  coarse.slope = fine.slope;
  coarse.intercept = fine.intercept;
  coarse.hounsfield = fine.hounsfield;
  std::visit([&](const auto& values) { coarse.values = std::remove_cvref_t<decltype(values)>(coarse.count()); },
             fine.values);
  return coarse;
}

void fill_coarse_slices(const VoxelGrid& fine, std::uint32_t begin, std::uint32_t end, VoxelGrid& coarse) {
  std::visit(
      [&](const auto& from) {
        using Values = std::remove_cvref_t<decltype(from)>;
        SliceHalver<typename Values::value_type> halver(fine, from, coarse, std::get<Values>(coarse.values));
        for (std::uint32_t k = begin; k < end; ++k) halver.fill(k);
      },
      fine.values);
}

}  // namespace cellmirror::volume
