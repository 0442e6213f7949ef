#include "ipc/sysv/system_file.hpp"

#include <fstream>

namespace cellmirror {

std::uint64_t number_in(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::uint64_t number = 0;
  in >> number;
  return in ? number : 0;
}

}  // namespace cellmirror
