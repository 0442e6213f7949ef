#include "config/display_reader.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "config/layout_file.hpp"
#include "config/stream_reader.hpp"
#include "rt_core/base/text.hpp"
#include "rt_core/ports/image.hpp"

namespace cellmirror {

namespace {

constexpr Range kRate{0.0, 60.0, true};
constexpr Range kEdge{kSmallestImageEdge, kLargestImageEdge};
constexpr long long kMostThreads = 16;

void read_size(TableReader& table, std::string_view key, int& width, int& height) {
  const auto size = table.numbers(key, 2, kEdge);
  if (!size) return;
  for (const double edge : *size) {
    if (edge == std::floor(edge)) continue;
    table.error(key, fmt::format("{:g} is not a whole number of pixels", edge),
                fmt::format("e.g. {} = [640, 480]", key));
    return;
  }
  width = static_cast<int>((*size)[0]);
  height = static_cast<int>((*size)[1]);
}

// Searched in the cell folder itself, beside the cell file.
std::optional<std::filesystem::path> read_layout_file(TableReader& table, const FileFinder& files) {
  const auto name = table.text("layout_file");
  if (!name) return std::nullopt;
  const std::string extension = std::filesystem::path(*name).extension().string();
  if (!extension.empty() && extension != kLayoutExtension) {
    table.error("layout_file", fmt::format("\"{}\" is not a layout file", printable(*name)),
                fmt::format("layout files end in {}; views (.vws) are loaded with LOAD_VIEWS", kLayoutExtension));
    return std::nullopt;
  }
  auto found = files.find(FileUse::layout, *name);
  if (found) return *std::move(found);
  table.error("layout_file", found.error().what, found.error().remedy);
  return std::nullopt;
}

}  // namespace

PictureSettings read_display(TableReader& top, const FileFinder& files,
                             std::optional<std::filesystem::path>& layout_file) {
  PictureSettings settings;
  auto table = top.table("display");
  if (!table) return settings;
  settings.on = table->boolean("on").value_or(settings.on);
  settings.rate_hz = table->number("rate_hz", kRate).value_or(settings.rate_hz);
  read_size(*table, "size", settings.width, settings.height);
  settings.renderer = table
                          ->choice<PictureRenderer>("renderer", {{"auto", PictureRenderer::automatic},
                                                                 {"osmesa", PictureRenderer::osmesa},
                                                                 {"egl", PictureRenderer::egl}})
                          .value_or(settings.renderer);
  settings.threads = static_cast<int>(table->integer("threads", 0, kMostThreads).value_or(settings.threads));
  layout_file = read_layout_file(*table, files);
  table->finish();
  return settings;
}

void read_dds_pictures(TableReader& table, DdsPictureConfig& config) {
  config.topic = read_topic(table, "picture_topic").value_or(config.topic);
  config.rate_hz = table.number("picture_rate_hz", kRate).value_or(config.rate_hz);
  if (const auto view = table.integer("picture_view", 0, 6)) config.view = static_cast<int>(*view);
  config.camera = table.text("picture_camera").value_or(config.camera);
  read_size(table, "picture_size", config.width, config.height);
  config.quality = static_cast<int>(table.integer("picture_quality", 1, 100).value_or(config.quality));
  if (config.view && !config.camera.empty())
    table.error("picture_camera", "a picture is of a view or of a camera", "remove one of the two keys");
}

}  // namespace cellmirror
