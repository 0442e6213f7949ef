#include "config/volume_user_tables.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

#include "config/first_error.hpp"
#include "config/tables_file.hpp"
#include "rt_core/ports/volume_settings.hpp"
#include "rt_core/volume/user_table.hpp"

namespace cellmirror {

namespace {

constexpr std::string_view kFolder = "envlib";
constexpr std::string_view kExtension = ".lut";

}  // namespace

std::string volume_table_file(std::size_t user_table) {
  const std::size_t word = kVolumeTables - kVolumeUserTables + user_table;
  return fmt::format("{}/{}{}", kFolder, kVolumeTableWords.at(word), kExtension);
}

Result<VolumeUserTables> load_volume_tables(const KismetHome& home) {
  VolumeUserTables read;
  for (std::size_t i = 0; i < kVolumeUserTables; ++i) {
    const std::string name = volume_table_file(i);
    std::error_code ignored;
    if (!std::filesystem::exists(std::filesystem::symlink_status(home.root() / name, ignored))) continue;
    const auto path = home.file("", name);
    if (!path) return std::unexpected(path.error());
    Diagnostics diagnostics;
    const auto text = text_of_file(*path, volume::kLongestUserTable, path->string(), diagnostics);
    auto table = text ? volume::parse_user_table(*text, path->string(), diagnostics) : std::nullopt;
    if (!table) return std::unexpected(first_error(diagnostics, *path));
    read.at(i) = std::make_shared<const VolumeUserTable>(*std::move(table));
  }
  return read;
}

}  // namespace cellmirror
