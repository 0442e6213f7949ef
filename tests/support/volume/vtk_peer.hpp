// Has VTK draw a volume (vtk_volume.py), for tests and benchmarks that compare with it.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "rt_core/ports/voxel_grid.hpp"
#include "rt_core/volume/transfer.hpp"
#include "tests/support/volume/cameras.hpp"

namespace cellmirror::phantoms {

struct VtkJob {
  const VoxelGrid* grid = nullptr;
  const volume::TransferFunction* transfer = nullptr;  // over stored values = values
  Camera camera;
  int width = 0;
  int height = 0;
  double step_m = 0;
  bool shade = false;
  int threads = 1;
  int repeats = 1;
};

struct VtkPicture {
  std::vector<std::uint8_t> rgb;  // on black, rows from the top; empty: VTK has failed
  std::string times;              // JSON: lists empty_s, wall_s, cpu_s
};

inline bool vtk_is_there() {
  return std::system(
             "command -v xvfb-run > /dev/null 2>&1 && /usr/bin/python3 -c 'import numpy, vtk' > /dev/null 2>&1") == 0;
}

inline std::string vector_text(const Eigen::Vector3d& v) { return fmt::format("[{}, {}, {}]", v.x(), v.y(), v.z()); }

inline VtkPicture draw_with_vtk(const VtkJob& job, const std::string& source_folder) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / fmt::format("cellmirror_vtk_{}", ::getpid());
  fs::create_directories(folder);
  const VoxelGrid& grid = *job.grid;
  static constexpr std::array<const char*, 3> kTypes = {"u8", "i16", "u16"};
  std::ofstream(folder / "job.json") << fmt::format(
      R"({{"type": "{}", "size": [{}, {}, {}], "spacing_m": {}, "width": {}, "height": {}, "from": {}, "to": {}, "up": {},
"near_m": {}, "far_m": {}, "height_m": {}, "opening_angle": {}, "step_m": {}, "shade": {}, "threads": {}, "repeats": {}}})",
      kTypes[grid.values.index()], grid.size[0], grid.size[1], grid.size[2], vector_text(grid.spacing_m), job.width,
      job.height, vector_text(job.camera.from), vector_text(job.camera.to), vector_text(job.camera.up),
      job.camera.near_m, job.camera.far_m, job.camera.height_m, job.camera.opening_angle, job.step_m,
      job.shade ? "true" : "false", job.threads, job.repeats);
  std::ofstream voxels(folder / "voxels.raw", std::ios::binary);
  std::visit(
      [&](const auto& all) {
        voxels.write(reinterpret_cast<const char*>(all.data()),
                     static_cast<std::streamsize>(all.size() * sizeof(all[0])));
      },
      grid.values);
  voxels.close();
  std::ofstream table(folder / "table.raw", std::ios::binary);
  const auto& entries = job.transfer->entries;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(entries.size() - 1);
    const auto value = static_cast<float>(std::lerp(job.transfer->range.low, job.transfer->range.high, part));
    const std::array<float, 5> row = {value, entries[i].rgb[0], entries[i].rgb[1], entries[i].rgb[2],
                                      entries[i].extinction};
    table.write(reinterpret_cast<const char*>(row.data()), sizeof(row));
  }
  table.close();
  const std::string command = fmt::format(
      "timeout 500 xvfb-run -a -s '-screen 0 1920x1200x24' /usr/bin/python3 -B "
      "'{}/tests/support/volume/vtk_volume.py' '{}' > '{}/log' 2>&1",
      source_folder, folder.string(), folder.string());
  VtkPicture made;
  if (std::system(command.c_str()) == 0) {
    std::ifstream picture(folder / "picture.raw", std::ios::binary);
    made.rgb.assign(std::istreambuf_iterator<char>(picture), {});
    std::ifstream times(folder / "times.json");
    made.times.assign(std::istreambuf_iterator<char>(times), {});
    if (made.rgb.size() != std::size_t{3} * static_cast<std::size_t>(job.width) * static_cast<std::size_t>(job.height))
      made.rgb.clear();
  } else {
    std::ifstream log(folder / "log");
    made.times.assign(std::istreambuf_iterator<char>(log), {});
  }
  fs::remove_all(folder);
  return made;
}

}  // namespace cellmirror::phantoms
