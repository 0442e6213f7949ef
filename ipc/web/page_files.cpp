#include "ipc/web/page_files.hpp"

#include <algorithm>

namespace cellmirror::web {

const PageFile* find_page_file(std::span<const PageFile> files, std::string_view path) {
  const auto found = std::ranges::find(files, path, &PageFile::path);
  return found == files.end() ? nullptr : &*found;
}

}  // namespace cellmirror::web
