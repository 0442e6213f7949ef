// Voxels are exempt from the locking of a process's memory (rt_core/rt/memory_lock.hpp): they are large, and no loop
// reads them. Any thread but the loop's.
#pragma once

#include <memory>

#include "config/volume/volume_data.hpp"

namespace cellmirror {

// Unlocks the voxels of all shared volumes, and those of later ones as they are shared. For a process that has locked
// its memory, present and future, which it calls after that.
void exempt_voxels_from_locking();

// A volume whose voxels are known to exempt_voxels_from_locking() as long as it lives. Memory that was unlocked is
// locked again before it is freed: it may become anything else.
[[nodiscard]] std::shared_ptr<const VolumeData> share_volume(VolumeData volume);

}  // namespace cellmirror
