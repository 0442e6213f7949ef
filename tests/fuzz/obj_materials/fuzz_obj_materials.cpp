// Any bytes as a material file of an OBJ, and as the OBJ that names some: bounded, in range, and the same when read
// twice.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "config/obj_materials.hpp"
#include "rt_core/base/contract.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  constexpr std::size_t kMostFiles = 16;
  constexpr std::size_t kLongestName = 1024;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto files = material_files(text);
  CELLMIRROR_EXPECTS(files.size() <= kMostFiles);
  for (const std::string& name : files) {
    CELLMIRROR_EXPECTS(!name.empty() && name.size() <= kLongestName && name.find('\n') == std::string::npos);
  }

  ObjMaterials materials;
  read_obj_materials(text, "fuzz.mtl", materials);
  for (const auto& [name, material] : materials) {
    CELLMIRROR_EXPECTS(!name.empty() && name.size() <= kLongestName);
    for (const float part : material.rgb) CELLMIRROR_EXPECTS(part >= 0.0F && part <= 1.0F);
    CELLMIRROR_EXPECTS(material.picture.size() <= kLongestName);
    CELLMIRROR_EXPECTS(material.picture.empty() || material.place.starts_with("fuzz.mtl:"));
  }
  const ObjMaterials before = materials;
  read_obj_materials(text, "again.mtl", materials);
  CELLMIRROR_EXPECTS(materials.size() == before.size());
  for (const auto& [name, material] : before) {
    CELLMIRROR_EXPECTS(materials.at(name).rgb == material.rgb && materials.at(name).place == material.place);
  }
  return 0;
}
