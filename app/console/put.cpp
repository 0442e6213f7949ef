#include "app/console/put.hpp"

#include <string>

namespace cellmirror::app {

void put_bundled(std::FILE* out, fmt::string_view text, fmt::format_args args) {
  const std::string line = fmt::vformat(text, args);
  std::fwrite(line.data(), 1, line.size(), out);
}

}  // namespace cellmirror::app
