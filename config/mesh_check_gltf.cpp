// assimp 5.2.5 allocates what the counts of a glTF say, and follows circles of nodes.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "config/file_finder.hpp"
#include "config/mesh_check.hpp"
#include "rt_core/geometry/mesh_repair/mesh_repair.hpp"

namespace cellmirror {

namespace {

class GltfCheck {
 public:
  explicit GltfCheck(const nlohmann::json& json) : json_(json) {}

  [[nodiscard]] Result<void> run() const {
    if (!json_.is_object()) return fail("it is not a glTF file");
    if (!counts_are_bounded(json_)) return fail("its counts exceed its size", "export it again");
    if (!nodes_are_trees()) return fail("its nodes form a loop, or a node is missing", "export it again");
    if (!meshes_are_bounded()) {
      return fail(fmt::format("its meshes refer to missing accessors, or have more than {} triangles",
                              geometry::kMostTriangles),
                  "reduce the mesh");
    }
    if (!pictures_are_bounded())
      return fail("its textures together exceed the size limit of a mesh", "give each image its own bytes");
    return {};
  }

 private:
  [[nodiscard]] const nlohmann::json& list(const char* key) const {
    static const nlohmann::json none = nlohmann::json::array();
    const auto at = json_.find(key);
    return at != json_.end() && at->is_array() ? *at : none;
  }

  [[nodiscard]] static bool counts_are_bounded(const nlohmann::json& all) {
    std::vector<const nlohmann::json*> open{&all};
    while (!open.empty()) {
      const nlohmann::json& top = *open.back();
      open.pop_back();
      if (!top.is_structured()) continue;
      for (const auto& [key, value] : top.items()) {
        if (value.is_structured()) open.push_back(&value);
        if (!top.is_object()) continue;
        const bool counts = key == "count" || key == "byteLength" || key == "byteOffset" || key == "byteStride";
        if (counts && (!value.is_number_unsigned() || value.get<std::uint64_t>() > kLargestMesh)) return false;
      }
    }
    return true;
  }

  // Each node has at most one parent, and is connected to a root.
  [[nodiscard]] bool nodes_are_trees() const {
    const auto& nodes = list("nodes");
    std::vector<int> parents(nodes.size());
    for (const auto& node : nodes) {
      if (!node.is_object()) return false;
      const auto children = node.find("children");
      if (children == node.end()) continue;
      if (!children->is_array()) return false;
      for (const auto& child : *children) {
        if (!child.is_number_unsigned() || child.get<std::uint64_t>() >= nodes.size()) return false;
        if (++parents[child.get<std::size_t>()] > 1) return false;
      }
    }
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (parents[i] == 0) open.push_back(i);
    }
    std::size_t reached = 0;
    for (; !open.empty(); ++reached) {
      const auto& node = nodes[open.back()];
      open.pop_back();
      if (!node.contains("children")) continue;
      for (const auto& child : node["children"]) open.push_back(child.get<std::size_t>());
    }
    constexpr std::size_t kMostNodes = 2000;  // a chain of all nodes: assimp walks by recursion
    return reached == nodes.size() && nodes.size() <= kMostNodes;
  }

  // What is allocated for all primitives together.
  [[nodiscard]] bool meshes_are_bounded() const {
    const auto& accessors = list("accessors");
    std::uint64_t total = 0;
    const auto add = [&](const nlohmann::json& accessor) {
      if (!accessor.is_number_unsigned() || accessor.get<std::uint64_t>() >= accessors.size()) return false;
      const auto& named = accessors[accessor.get<std::size_t>()];
      if (!named.is_object() || !named.contains("count")) return false;
      total += named["count"].get<std::uint64_t>();
      return true;
    };
    for (const auto& mesh : list("meshes")) {
      if (!mesh.is_object() || !mesh.contains("primitives") || !mesh["primitives"].is_array()) return false;
      for (const auto& primitive : mesh["primitives"]) {
        if (!primitive.is_object() || !primitive.contains("attributes") || !primitive["attributes"].is_object())
          return false;
        for (const auto& [name, accessor] : primitive["attributes"].items()) {
          if (!add(accessor)) return false;
        }
        if (primitive.contains("indices") && !add(primitive["indices"])) return false;
      }
    }
    constexpr std::uint64_t kMost = 12 * geometry::kMostTriangles;
    return total <= kMost;
  }

  // assimp copies the bytes of each image, of those too that many have in common.
  [[nodiscard]] bool pictures_are_bounded() const {
    const auto& views = list("bufferViews");
    std::uint64_t total = 0;
    for (const auto& image : list("images")) {
      if (!image.is_object() || !image.contains("bufferView")) continue;
      const auto& view = image["bufferView"];
      if (!view.is_number_unsigned() || view.get<std::uint64_t>() >= views.size()) return false;
      const auto& named = views[view.get<std::size_t>()];
      if (named.is_object() && named.contains("byteLength")) total += named["byteLength"].get<std::uint64_t>();
      if (total > kLargestMesh) return false;
    }
    return true;
  }

  const nlohmann::json& json_;
};

}  // namespace

Result<void> check_gltf(std::string_view text) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (json.is_discarded()) return fail("its JSON is faulty", "export it again");
  return GltfCheck(json).run();
}

Result<void> check_glb(std::string_view bytes) {
  constexpr std::size_t kHeader = 20;  // of the file and its first chunk, which is the JSON
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;) value = (value << 8U) | static_cast<unsigned char>(bytes[at + i]);
    return std::size_t{value};
  };
  if (bytes.size() < kHeader || !bytes.starts_with("glTF") || bytes.substr(16, 4) != "JSON")
    return fail("it is not a GLB of version 2");
  if (number(4) != 2 || number(8) != bytes.size()) return fail("its length differs from its header", "export it again");
  const std::size_t length = number(12);
  if (length > bytes.size() - kHeader) return fail("its JSON reaches beyond its end", "export it again");
  constexpr std::size_t kChunkHeader = 8;
  const std::size_t rest = bytes.size() - kHeader - length;
  const std::size_t chunk = kHeader + length;
  if (rest > 0 && (rest < kChunkHeader || number(chunk) > rest - kChunkHeader))
    return fail("its buffer reaches beyond its end", "export it again");
  return check_gltf(bytes.substr(kHeader, length));
}

std::vector<std::string> gltf_buffer_files(std::string_view text, std::size_t most) {
  std::vector<std::string> out;
  const auto json = nlohmann::json::parse(text, nullptr, false);
  const auto buffers = json.is_object() ? json.find("buffers") : json.end();
  if (buffers == json.end() || !buffers->is_array()) return out;
  for (const auto& buffer : *buffers) {
    if (out.size() >= most) break;
    if (!buffer.is_object() || !buffer.contains("uri") || !buffer["uri"].is_string()) continue;
    const auto& name = buffer["uri"].get_ref<const std::string&>();
    if (name.ends_with(".bin") && std::ranges::find(out, name) == out.end()) out.push_back(name);
  }
  return out;
}

}  // namespace cellmirror
