#include "config/volume/volume_data.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <cmath>
#include <string_view>

#include "rt_core/base/descriptor.hpp"

namespace cellmirror {

namespace {

// None where the kernel does not say.
std::optional<std::uint64_t> available_memory() {
  const Descriptor file(open("/proc/meminfo", O_RDONLY | O_CLOEXEC));
  std::array<char, 4096> text{};
  const ssize_t count = file.valid() ? read(file.get(), text.data(), text.size()) : 0;
  if (count <= 0) return std::nullopt;
  std::string_view left(text.data(), static_cast<std::size_t>(count));
  constexpr std::string_view kKey = "MemAvailable:";
  const std::size_t at = left.find(kKey);
  if (at == std::string_view::npos) return std::nullopt;
  left.remove_prefix(at + kKey.size());
  left.remove_prefix(std::min(left.find_first_not_of(' '), left.size()));
  std::uint64_t kib = 0;
  if (std::from_chars(left.data(), left.data() + left.size(), kib).ec != std::errc{}) return std::nullopt;
  return kib << 10U;
}

}  // namespace

Result<void> check_voxels(const std::array<std::uint64_t, 3>& size, std::size_t bytes_per_voxel) {
  const auto text = [&] { return fmt::format("{} x {} x {} voxels", size[0], size[1], size[2]); };
  for (const std::uint64_t along : size) {
    if (along < 2) return fail(text() + ": a volume has at least 2 voxels along each axis");
    if (along > kMostVoxelsAlong)
      return fail(fmt::format("{} are more than {} along an axis", text(), kMostVoxelsAlong), "crop the volume");
  }
  const std::uint64_t count = size[0] * size[1] * size[2];
  if (count > kMostVoxels)
    return fail(fmt::format("{} are more than {}", text(), kMostVoxels), "crop the volume, or halve its resolution");
  constexpr std::uint64_t kSpareShare = 4;  // of what is free, a quarter stays so
  const std::uint64_t bytes = count * bytes_per_voxel;
  const auto free = available_memory();
  if (free && bytes > *free - *free / kSpareShare) {
    return fail(fmt::format("{} take {} MiB, {} MiB of memory are free", text(), bytes >> 20U, *free >> 20U),
                "crop the volume, or free memory of other programs");
  }
  return {};
}

Result<void> check_spacing(const Eigen::Vector3d& spacing_m) {
  for (const double along : spacing_m) {
    if (!(along >= kLeastSpacing && along <= kMostSpacing)) {
      return fail(fmt::format("the spacing {:g} x {:g} x {:g} mm is not between {:g} and {:g} mm", spacing_m.x() * 1e3,
                              spacing_m.y() * 1e3, spacing_m.z() * 1e3, kLeastSpacing * 1e3, kMostSpacing * 1e3));
    }
  }
  return {};
}

std::string size_text(const std::array<std::uint32_t, 3>& size) {
  return fmt::format("{} x {} x {}", size[0], size[1], size[2]);
}

}  // namespace cellmirror
