// TOML files of tables with ids that are good or refused as a whole: view and layout files. Private to this folder.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "config/parse.hpp"
#include "config/table_reader.hpp"
#include "rt_core/base/diagnostics.hpp"

namespace cellmirror {

// The text of the file at `path`, whose name for messages is `shown`; nothing, and why, where it cannot be read.
[[nodiscard]] std::optional<std::string> text_of_file(const std::filesystem::path& path, std::size_t largest,
                                                      const std::string& shown, Diagnostics& diagnostics);

// The key "id" of a `what`, where it is a good one that is not among those `before`, to which it is added.
[[nodiscard]] std::optional<int> read_new_id(TableReader& table, int lowest, int highest, const char* what,
                                             std::vector<int>& before);

// What read(table, content) makes of the outermost table; nothing where anything is wrong.
template <class Content, class Read>
[[nodiscard]] std::optional<Content> parse_tables(std::string_view text, const std::string& file,
                                                  Diagnostics& diagnostics, Read read) {
  Diagnostics findings;
  Content content;
  if (const auto table = parse_toml(text, file, findings)) {
    TableReader top(*table, file, "", findings);
    top.format();
    read(top, content);
    top.finish();
  }
  const bool good = findings.ok();
  take_sorted(diagnostics, findings);
  return good ? std::optional(std::move(content)) : std::nullopt;
}

}  // namespace cellmirror
