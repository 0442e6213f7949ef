// The files of the pages, embedded in the program (page/, wall_page/, embed_page.cmake).
#pragma once

#include <span>
#include <string_view>

namespace cellmirror::web {

struct PageFile {
  std::string_view path;  // of the URL: "/" or "/page/modules/main.js"
  std::string_view content_type;
  std::string_view etag;  // with its quotes
  std::string_view bytes;
  std::string_view gzip;  // empty where it would not be smaller
};

// Of the monitor page.
[[nodiscard]] std::span<const PageFile> page_files();
// Of the wall, the page of many cells.
[[nodiscard]] std::span<const PageFile> wall_page_files();
// Null: there is none.
[[nodiscard]] const PageFile* find_page_file(std::span<const PageFile> files, std::string_view path);

}  // namespace cellmirror::web
