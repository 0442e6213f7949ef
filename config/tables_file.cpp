#include "config/tables_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "rt_core/base/home.hpp"

namespace cellmirror {

std::optional<std::string> text_of_file(const std::filesystem::path& path, std::size_t largest,
                                        const std::string& shown, Diagnostics& diagnostics) {
  auto text = read_text_file(path, largest);
  if (text) return std::move(*text);
  diagnostics.error({shown}, text.error().what, text.error().remedy);
  return std::nullopt;
}

std::optional<int> read_new_id(TableReader& table, int lowest, int highest, const char* what,
                               std::vector<int>& before) {
  table.require("id");
  const auto read = table.integer("id", lowest, highest);
  if (!read) return std::nullopt;
  const int id = static_cast<int>(*read);
  if (std::ranges::find(before, id) != before.end()) {
    table.error("id", fmt::format("{} {} appears twice", what, id));
    return std::nullopt;
  }
  before.push_back(id);
  return id;
}

}  // namespace cellmirror
