#include "config/wall_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "config/dds_network_reader.hpp"
#include "config/dds_reader.hpp"
#include "config/stream_reader.hpp"
#include "config/tables_file.hpp"
#include "config/web_reader.hpp"
#include "rt_core/base/text.hpp"
#include "rt_core/ports/cell_summary.hpp"

namespace cellmirror {

namespace {

constexpr std::size_t kLongestPage = 255;

// "http://host[:port][/path]" without what could carry a secret.
bool is_page(std::string_view text) {
  const std::size_t scheme = text.starts_with("http://") ? 7 : text.starts_with("https://") ? 8 : 0;
  static constexpr std::string_view kOthers = "-._~:[]/%";
  return scheme > 0 && text.size() > scheme && text[scheme] != '/' && text.size() <= kLongestPage &&
         std::ranges::all_of(text, [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                  kOthers.find(c) != std::string_view::npos;
         });
}

std::string read_short(TableReader& table, std::string_view key) {
  auto text = table.text(key);
  if (!text) return {};
  if (text->size() <= kMostSummaryText) return std::move(*text);
  table.error(key, fmt::format("{} has {} bytes, but at most {} are allowed", key, text->size(), kMostSummaryText));
  return {};
}

void read_page(TableReader& table, WallCell& cell) {
  const auto page = table.text("page");
  if (!page) return;
  if (is_page(*page)) {
    cell.page = *page;
    return;
  }
  table.error("page", fmt::format("\"{}\" is not the address of a page", printable(*page)),
              "e.g. http://127.0.0.1:9001/, without the token: the browser keeps that of each page");
}

void read_cell(TableReader& table, WallSettings& out, std::set<std::string>& names) {
  table.require("name");
  WallCell cell;
  cell.name = read_short(table, "name");
  if (!cell.name.empty()) table.set_where("cell " + printable(cell.name));
  cell.title = read_short(table, "title");
  cell.host = read_short(table, "host");
  cell.instance = read_short(table, "instance");
  read_page(table, cell);
  cell.thumbnail = read_topic(table, "thumbnail").value_or("");
  cell.partition = read_partition(table, "partition");
  table.finish();
  if (table.has("name") && cell.name.empty()) table.error("name", "the name is empty");
  if (cell.name.empty()) return;
  if (!names.insert(cell.name).second)
    table.error("name", "the name appears twice", "a cell has one gateway; rename one of the two in its cell file");
  out.cells.push_back(std::move(cell));
}

void read_wall_table(TableReader& top, WallSettings& out) {
  auto table = top.table("wall");
  if (!table) return;
  if (const auto port = table->integer("port", 1, 65535)) out.port = static_cast<int>(*port);
  out.address = read_page_address(*table, out.address);
  if (const auto domain = table->integer("domain", 0, 232)) out.domain = static_cast<int>(*domain);
  out.interface_address = read_own_address(*table, "interface_address").value_or(out.interface_address);
  out.topic = read_topic(*table, "summary_topic").value_or(out.topic);
  if (const auto after = read_seconds(*table, "silent_after_s", 3600, false)) out.silent_after = *after;
  table->finish();
}

}  // namespace

std::optional<WallSettings> parse_wall(std::string_view text, const std::string& file, const FileFinder& files,
                                       Diagnostics& diagnostics) {
  return parse_tables<WallSettings>(text, file, diagnostics, [&](TableReader& top, WallSettings& out) {
    read_wall_table(top, out);
    out.security = read_dds(top, files, out.ros, out.network);
    std::set<std::string> names;
    for (TableReader& table : top.tables("cell", kMostWallCells)) read_cell(table, out, names);
    const auto pictures = static_cast<std::size_t>(
        std::ranges::count_if(out.cells, [](const WallCell& cell) { return !cell.thumbnail.empty(); }));
    if (pictures > kMostWallThumbnails)
      top.error("cell", fmt::format("{} cells have a thumbnail, but at most {} may", pictures, kMostWallThumbnails));
  });
}

std::optional<WallSettings> read_wall(const std::filesystem::path& path, Diagnostics& diagnostics) {
  const std::string shown = path.string();
  const auto text = text_of_file(path, kLargestWallFile, shown, diagnostics);
  if (!text) return std::nullopt;
  const auto home = KismetHome::open(std::filesystem::absolute(path).parent_path());
  if (!home) {
    diagnostics.error({shown}, home.error().what, home.error().remedy);
    return std::nullopt;
  }
  return parse_wall(*text, shown, HomeFiles(*home), diagnostics);
}

}  // namespace cellmirror
