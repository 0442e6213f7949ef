#include "config/volume/voxel_memory.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <map>
#include <mutex>
#include <utility>
#include <variant>

namespace cellmirror {

namespace {

// Whole pages.
struct Pages {
  void* first = nullptr;
  std::size_t bytes = 0;
};

// Pages that hold nothing but voxels.
Pages pages_of(const VoxelGrid& grid) {
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  const auto [begin, bytes] = std::visit(
      [](const auto& values) {
        return std::pair(reinterpret_cast<std::uintptr_t>(values.data()), values.size() * sizeof(values[0]));
      },
      grid.values);
  const std::uintptr_t first = (begin + page - 1) / page * page;
  const std::uintptr_t end = (begin + bytes) / page * page;
  if (first >= end) return {};
  return {reinterpret_cast<void*>(first), end - first};
}

class LivingVoxels {
 public:
  void exempt() {
    const std::lock_guard guard(mutex_);
    exempt_ = true;
    for (auto& [grid, unlocked] : living_) unlocked = unlock(*grid);
  }
  void add(const VoxelGrid& grid) {
    const std::lock_guard guard(mutex_);
    living_[&grid] = exempt_ && unlock(grid);
  }
  void remove(const VoxelGrid& grid) {
    const std::lock_guard guard(mutex_);
    const auto at = living_.find(&grid);
    if (at == living_.end()) return;
    const Pages pages = pages_of(grid);
    // As MCL_FUTURE with MCL_ONFAULT has it.
    if (at->second) mlock2(pages.first, pages.bytes, MLOCK_ONFAULT);
    living_.erase(at);
  }

 private:
  static bool unlock(const VoxelGrid& grid) {
    const Pages pages = pages_of(grid);
    return pages.bytes > 0 && munlock(pages.first, pages.bytes) == 0;
  }

  std::mutex mutex_;
  bool exempt_ = false;
  std::map<const VoxelGrid*, bool> living_;  // whether it was unlocked
};

LivingVoxels& living_voxels() {
  static auto* const voxels = new LivingVoxels;  // outlives every volume
  return *voxels;
}

}  // namespace

void exempt_voxels_from_locking() { living_voxels().exempt(); }

std::shared_ptr<const VolumeData> share_volume(VolumeData volume) {
  auto owned = std::make_unique<const VolumeData>(std::move(volume));
  living_voxels().add(owned->grid);
  return {owned.release(), [](const VolumeData* gone) {
            living_voxels().remove(gone->grid);
            delete gone;
          }};
}

}  // namespace cellmirror
