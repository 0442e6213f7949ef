// Any bytes as the file with the address of a gateway's page (page.json): an address, or a reason.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "ipc/web/page_address.hpp"
#include "rt_core/base/contract.hpp"

namespace {

struct Folder {
  Folder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "cellmirror-fuzz-XXXXXX").string();
    CELLMIRROR_EXPECTS(mkdtemp(pattern.data()) != nullptr);
    path = pattern;
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::filesystem::path path;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror::web;
  static const Folder folder;
  std::ofstream(folder.path / kPageAddressFile, std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  const auto page = read_page_address(folder.path);
  if (page) {
    CELLMIRROR_EXPECTS(page->url().starts_with("http://"));
    CELLMIRROR_EXPECTS(page->url_with_token().starts_with(page->url()));
  } else {
    CELLMIRROR_EXPECTS(!page.error().what.empty() && !page.error().remedy.empty());
  }
  return 0;
}
