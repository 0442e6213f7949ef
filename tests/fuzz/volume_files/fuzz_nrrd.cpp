// Any bytes as a NRRD file: findings, or a volume whose size, spacing and values fit together.
#include <unistd.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <variant>

#include "config/volume/nrrd_file.hpp"
#include "config/volume/nrrd_head.hpp"
#include "rt_core/base/contract.hpp"

namespace {

using namespace cellmirror;

// In a folder of this process, since the data are read from the file.
std::filesystem::path file_for_input() {
  static const std::filesystem::path folder = [] {
    std::string name = (std::filesystem::temp_directory_path() / "volume_fuzz_XXXXXX").string();
    CELLMIRROR_EXPECTS(mkdtemp(name.data()) != nullptr);
    return std::filesystem::path(name);
  }();
  static const struct Remover {
    ~Remover() { std::filesystem::remove_all(folder); }
  } remover;
  return folder / "a.nrrd";
}

void check_head(std::string_view text) {
  Diagnostics diagnostics;
  const auto head = parse_nrrd_head(text, "a.nrrd", diagnostics);
  CELLMIRROR_EXPECTS(head.has_value() == diagnostics.ok());
  if (!head) return;
  for (const std::uint32_t along : head->format.size) CELLMIRROR_EXPECTS(along >= 2 && along <= kMostVoxelsAlong);
  CELLMIRROR_EXPECTS(check_spacing(head->spacing_m).has_value());
  CELLMIRROR_EXPECTS(!head->X_PV || head->X_PV->matrix().allFinite());
  CELLMIRROR_EXPECTS(!head->X_PV || std::abs(head->X_PV->linear().determinant() - 1) < 1e-6);
  CELLMIRROR_EXPECTS(head->data_offset <= text.size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kLargest = 8UL << 10U;
  if (size > kLargest) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  check_head(text);
  const std::filesystem::path path = file_for_input();
  std::ofstream(path, std::ios::binary | std::ios::trunc) << text;
  Diagnostics diagnostics;
  const auto volume = read_nrrd(path, diagnostics);
  CELLMIRROR_EXPECTS(volume.has_value() == diagnostics.ok());
  if (!volume) return 0;
  const std::size_t values = std::visit([](const auto& list) { return list.size(); }, volume->grid.values);
  CELLMIRROR_EXPECTS(values == volume->grid.count());
  CELLMIRROR_EXPECTS(std::isfinite(volume->grid.slope) && volume->grid.slope != 0);
  CELLMIRROR_EXPECTS(std::isfinite(volume->grid.intercept));
  return 0;
}
