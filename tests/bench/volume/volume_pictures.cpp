// Pictures a second of a volume of 512^3 at 1280 x 720 with each table, at full quality and while it moves; beside
// VTK's vtkFixedPointVolumeRayCastMapper at the same step and its mean error against a picture of fine steps; the time
// over the size of the volume. Writes a table (CSV) and a figure of it (PNG). --size measures one size alone and keeps
// the rows of others that are in the table already: a size at a time takes less than a minute and less memory.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "app/plot/figure.hpp"
#include "rt_core/volume/caster.hpp"
#include "tests/support/volume/phantoms.hpp"
#include "tests/support/volume/vtk_peer.hpp"

namespace {

using namespace cellmirror;

constexpr int kWidth = 1280;
constexpr int kHeight = 720;
constexpr int kPictures = 15;
constexpr int kMovingReduction = 2;  // pixels
constexpr std::array<std::uint32_t, 7> kSizes = {128, 192, 256, 384, 512, 768, 1024};
constexpr std::uint32_t kLeastSize = 16;
constexpr int kThreads = 1;  // beside the calling one

double now_s(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Times {
  double wall_ms = 0;  // medians
  double cpu_ms = 0;
};

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

// The eye goes around the volume by some degrees.
phantoms::Camera camera_at(int i) {
  const double turn = 0.6 + 0.02 * i;
  return {.from = Eigen::Vector3d(0.95 * std::sin(turn), -0.95 * std::cos(turn), 0.25), .near_m = 0.05, .far_m = 5};
}

volume::CastRequest request_of(const std::shared_ptr<const VoxelGrid>& grid, const VolumeSettings& settings,
                               bool moving, int i) {
  volume::CastRequest request;
  request.grid = grid;
  request.settings = settings;
  request.width = moving ? kWidth / kMovingReduction : kWidth;
  request.height = moving ? kHeight / kMovingReduction : kHeight;
  request.clip_from_V = phantoms::clip_from_world(camera_at(i), request.width, request.height);
  if (moving) {
    request.quality = volume::kHastyQuality;  // as the renderer takes it where pixels are larger than voxels
    request.quality.coarse = volume::CoarseVoxels::always;
    request.quality.step_voxels = 2;
  }
  return request;
}

Times measure(volume::Caster& caster, const std::shared_ptr<const VoxelGrid>& grid, const VolumeSettings& settings,
              bool moving) {
  std::vector<double> wall;
  std::vector<double> cpu;
  volume::VolumePicture picture;
  for (int i = 0; i < kPictures; ++i) {
    const volume::CastRequest request = request_of(grid, settings, moving, i);
    const double wall_begun = now_s(CLOCK_MONOTONIC);
    const double cpu_begun = now_s(CLOCK_PROCESS_CPUTIME_ID);
    if (const auto done = caster.cast(request, picture); !done) {
      fmt::print(stderr, "{}\n", done.error().text());
      return {};
    }
    if (i < 2) continue;
    wall.push_back(1e3 * (now_s(CLOCK_MONOTONIC) - wall_begun));
    cpu.push_back(1e3 * (now_s(CLOCK_PROCESS_CPUTIME_ID) - cpu_begun));
  }
  return {median(wall), median(cpu)};
}

struct Shown {
  std::string name;
  VolumeSettings settings;
};

std::vector<Shown> all_shown() {
  std::vector<Shown> shown;
  for (std::size_t t = 0; t < kVolumeTables; ++t) {
    VolumeSettings settings;
    settings.table = static_cast<VolumeTable>(t);
    shown.push_back({std::string(kVolumeTableWords[t]), settings});
  }
  VolumeSettings surface;
  surface.isosurface = true;
  shown.push_back({"isosurface", surface});
  return shown;
}

// Until its picture is there, while it moves; `prepared`: before the rays.
void measure_change_of_table(volume::Caster& caster, const std::shared_ptr<const VoxelGrid>& grid) {
  volume::VolumePicture picture;
  const auto measured = [&](bool one_pixel, double tissue) {
    std::vector<double> ms;
    for (int i = 0; i < 10; ++i) {
      volume::CastRequest request = request_of(grid, {}, true, 0);
      request.settings.medical.tissue = tissue + 0.01 * i;
      if (one_pixel) request.width = request.height = 1;
      const double begun = now_s(CLOCK_MONOTONIC);
      static_cast<void>(caster.cast(request, picture));
      ms.push_back(1e3 * (now_s(CLOCK_MONOTONIC) - begun));
    }
    return median(ms);
  };
  const double prepared = measured(true, 0.2);
  fmt::print("a change of table before the rays: {:.1f} ms; with a picture while moving: {:.1f} ms\n", prepared,
             measured(false, 0.305));
}

// Mean difference of two pictures on black where either shows something.
double mean_error(const volume::VolumePicture& reference, const std::vector<std::uint8_t>& other, std::size_t stride) {
  double sum = 0;
  std::size_t covered = 0;
  for (std::size_t i = 0; i < reference.depth.size(); ++i) {
    int difference = 0;
    for (std::size_t c = 0; c < 3; ++c) difference += std::abs(reference.rgba[4 * i + c] - other[stride * i + c]);
    covered += reference.rgba[4 * i + 3] > 0 ? 1U : 0U;
    sum += difference / 3.0;
  }
  return sum / static_cast<double>(std::max<std::size_t>(covered, 1));
}

// Without light: VTK's goes by other gradients.
void compare_with_vtk(volume::Caster& caster, const std::shared_ptr<const VoxelGrid>& grid, const char* source) {
  volume::CastRequest request = request_of(grid, {}, false, 0);
  request.quality.light = false;
  volume::VolumePicture picture;
  volume::VolumePicture fine;
  Times own;
  std::vector<double> wall;
  std::vector<double> cpu;
  for (int i = 0; i < 7; ++i) {
    const double wall_begun = now_s(CLOCK_MONOTONIC);
    const double cpu_begun = now_s(CLOCK_PROCESS_CPUTIME_ID);
    static_cast<void>(caster.cast(request, picture));
    wall.push_back(now_s(CLOCK_MONOTONIC) - wall_begun);
    cpu.push_back(now_s(CLOCK_PROCESS_CPUTIME_ID) - cpu_begun);
  }
  own = {1e3 * median(wall), 1e3 * median(cpu)};
  request.quality = volume::kEvenQuality;
  request.quality.light = false;
  request.quality.step_voxels = 0.25;
  static_cast<void>(caster.cast(request, fine));
  const auto range = caster.range_of(grid);
  if (!range) return;
  const volume::TransferFunction transfer =
      volume::make_transfer({.settings = {}, .range = *range, .hounsfield = true, .longest_edge_m = 0.4, .user = {}});
  const phantoms::VtkPicture vtk = phantoms::draw_with_vtk({.grid = grid.get(),
                                                            .transfer = &transfer,
                                                            .camera = camera_at(0),
                                                            .width = kWidth,
                                                            .height = kHeight,
                                                            .step_m = grid->spacing_m.minCoeff(),
                                                            .shade = false,
                                                            .threads = 1 + kThreads,
                                                            .repeats = 5},
                                                           source);
  if (vtk.rgb.empty()) {
    fmt::print("VTK has failed: {}\n", vtk.times);
    return;
  }
  fmt::print(
      "MEDICAL_LUT without light, step of a voxel: {:.0f} ms ({:.0f} ms processor), mean error {:.2f} of 255; VTK "
      "mean error {:.2f}, times in s {}\n",
      own.wall_ms, own.cpu_ms, mean_error(fine, picture.rgba, 4), mean_error(fine, vtk.rgb, 3), vtk.times);
}

// Of the table that is written.
struct Row {
  std::uint32_t size = 0;
  std::string table;
  Times full;
  Times moving;
  double prepare_ms = 0;
};

constexpr const char* kHead = "size,table,full_ms,full_cpu_ms,moving_ms,moving_cpu_ms,prepare_ms\n";

// None where there is no such file.
std::vector<Row> read_rows(const std::string& path) {
  std::vector<Row> rows;
  std::FILE* const file = std::fopen(path.c_str(), "r");
  if (file == nullptr) return rows;
  std::array<char, 256> line{};
  while (std::fgets(line.data(), static_cast<int>(line.size()), file) != nullptr) {
    Row row;
    std::array<char, 32> table{};
    if (std::sscanf(line.data(), "%u,%31[^,],%lf,%lf,%lf,%lf,%lf", &row.size, table.data(), &row.full.wall_ms,
                    &row.full.cpu_ms, &row.moving.wall_ms, &row.moving.cpu_ms, &row.prepare_ms) != 7)
      continue;
    row.table = table.data();
    rows.push_back(row);
  }
  std::fclose(file);
  return rows;
}

bool write_rows(const std::vector<Row>& rows, const std::string& path) {
  std::string text = kHead;
  for (const Row& row : rows)
    text += fmt::format("{},{},{:.2f},{:.2f},{:.2f},{:.2f},{:.1f}\n", row.size, row.table, row.full.wall_ms,
                        row.full.cpu_ms, row.moving.wall_ms, row.moving.cpu_ms, row.prepare_ms);
  std::FILE* const file = std::fopen(path.c_str(), "w");
  return file != nullptr && std::fputs(text.c_str(), file) >= 0 && std::fclose(file) == 0;
}

plot::Figure figure_of(const std::vector<Row>& rows) {
  plot::Line full{.label = "full quality", .x = {}, .y = {}};
  plot::Line moving{.label = "moving", .x = {}, .y = {}};
  for (const Row& row : rows) {
    if (row.table != kVolumeTableWords[0]) continue;
    full.x.push_back(row.size);
    full.y.push_back(row.full.cpu_ms);
    moving.x.push_back(row.size);
    moving.y.push_back(row.moving.cpu_ms);
  }
  plot::Panel panel;
  panel.x = {.label = "voxels along an edge", .logarithmic = true};
  panel.y = {.label = "processor time of a picture [ms]", .logarithmic = true};
  panel.lines = {full, moving};
  plot::Figure figure;
  figure.title = "Processor time of a picture of a volume over its size";
  figure.subtitle = fmt::format("{} x {} pixels, MEDICAL_LUT, {}, {} threads", kWidth, kHeight,
                                volume::caster_simd_target(), 1 + kThreads);
  figure.panels.push_back(panel);
  figure.columns = 1;
  return figure;
}

struct Options {
  bool vtk = false;
  bool others = false;  // rows of other sizes are kept
  std::vector<std::uint32_t> sizes{kSizes.begin(), kSizes.end()};
  std::string table;
  std::string picture;
};

std::optional<Options> options_of(std::span<char* const> arguments) {
  Options options;
  std::vector<std::string> files;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string word = arguments[i];
    if (word == "--vtk") {
      options.vtk = true;
    } else if (word == "--size" && i + 1 < arguments.size()) {
      const unsigned long size = std::strtoul(arguments[++i], nullptr, 10);
      if (size < kLeastSize || size > kSizes.back()) return std::nullopt;
      options.sizes = {static_cast<std::uint32_t>(size)};
      options.others = true;
    } else {
      files.push_back(word);
    }
  }
  if (files.size() != 2) return std::nullopt;
  options.table = files[0];
  options.picture = files[1];
  return options;
}

}  // namespace

int main(int count, char** arguments) {
  const std::optional<Options> options = options_of(std::span(arguments, static_cast<std::size_t>(count)).subspan(1));
  if (!options) {
    std::fputs("usage: volume_pictures [--vtk] [--size VOXELS] CSV PNG\n", stderr);
    return 2;
  }
  fmt::print("instruction set {}, {} threads\n", volume::caster_simd_target(), 1 + kThreads);
  volume::Caster caster(kThreads);
  std::vector<Row> rows = options->others ? read_rows(options->table) : std::vector<Row>();
  std::erase_if(rows, [&](const Row& row) { return row.size == options->sizes.front(); });
  for (const std::uint32_t size : options->sizes) {
    const std::shared_ptr<const VoxelGrid> grid = phantoms::trunk_grid(size, 0.40, 1 + kThreads);
    caster.keep_only({});
    const double begun = now_s(CLOCK_MONOTONIC);
    if (const auto range = caster.range_of(grid); !range) {
      fmt::print(stderr, "{}\n", range.error().text());
      return 1;
    }
    const double prepare_ms = 1e3 * (now_s(CLOCK_MONOTONIC) - begun);
    for (const Shown& shown : all_shown()) {
      if (size != 512 && shown.settings.isosurface) continue;
      if (size != 512 && shown.settings.table != VolumeTable::medical) continue;
      const Times full = measure(caster, grid, shown.settings, false);
      const Times moving = measure(caster, grid, shown.settings, true);
      fmt::print(
          "{:4}^3 {:11}: full {:6.1f} ms ({:.1f} a second; {:.1f} ms processor), moving {:5.1f} ms ({:.1f} a second; "
          "{:.1f} ms processor), prepared in {:.0f} ms\n",
          size, shown.name, full.wall_ms, 1e3 / full.wall_ms, full.cpu_ms, moving.wall_ms, 1e3 / moving.wall_ms,
          moving.cpu_ms, prepare_ms);
      rows.insert(std::ranges::upper_bound(rows, size, {}, &Row::size), {size, shown.name, full, moving, prepare_ms});
    }
    if (size == 512) measure_change_of_table(caster, grid);
    const char* const source = std::getenv("CELLMIRROR_SOURCE_DIR");
    if (size == 512 && options->vtk) compare_with_vtk(caster, grid, source != nullptr ? source : ".");
  }
  if (!write_rows(rows, options->table)) {
    fmt::print(stderr, "{} cannot be written\n", options->table);
    return 1;
  }
  if (auto written = plot::write_png(figure_of(rows), options->picture); !written) {
    fmt::print(stderr, "{}\n", written.error().text());
    return 1;
  }
  return 0;
}
