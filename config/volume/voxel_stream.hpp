// The bytes of voxels from one or several files, in order, raw or gzip.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "rt_core/base/descriptor.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror {

// A regular file, open for reading; never waits, as for a pipe.
struct OpenedFile {
  Descriptor descriptor;
  std::uint64_t bytes = 0;
};
[[nodiscard]] Result<OpenedFile> open_regular_file(const std::filesystem::path& path);

// `count` bytes from `offset`, or to the end of the file.
[[nodiscard]] Result<std::string> read_part_of_file(const std::filesystem::path& path, std::uint64_t offset,
                                                    std::size_t count);

class VoxelStream {
 public:
  virtual ~VoxelStream() = default;
  // Fills `to`; fails where the data ends before.
  [[nodiscard]] virtual Result<void> read(std::span<std::byte> to) = 0;
};

struct VoxelSource {
  std::vector<std::filesystem::path> files;  // all of the same length where there are several
  std::uint64_t skip_bytes = 0;              // before the data of each file
  bool at_end = false;                       // the data ends with the file instead of following skip_bytes (one file)
  bool gzip = false;                         // one file
};

// A new stream of `bytes` bytes. Refused before memory is taken for them: files that cannot hold as many.
[[nodiscard]] Result<std::unique_ptr<VoxelStream>> open_voxels(const VoxelSource& source, std::uint64_t bytes);

}  // namespace cellmirror
