#include "config/mesh_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "config/file_finder.hpp"
#include "config/mesh_appearance.hpp"
#include "config/mesh_check.hpp"
#include "config/mesh_finish.hpp"
#include "config/mesh_process.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace fs = std::filesystem;
using geometry::MeshFindings;
using geometry::TriangleMesh;

namespace {

constexpr std::array<std::string_view, 6> kFormats{".stl", ".obj", ".dae", ".ply", ".gltf", ".glb"};

// STL has no colours that two programs would agree on.
bool may_have_looks(std::string_view extension) { return extension != ".stl"; }

// The buffers beside a glTF. The reader alone knows which of them it takes: a missing one counts only if the mesh
// cannot be read.
struct Buffers {
  std::vector<std::pair<std::string, std::string>> found;
  std::string refusal;
};

Buffers find_buffers(std::string_view bytes, std::string_view extension, const Neighbours& neighbours) {
  constexpr std::size_t kMostBuffers = 16;
  Buffers out;
  if (extension != ".gltf" || !neighbours) return out;
  std::size_t total = 0;
  for (const std::string& name : gltf_buffer_files(bytes, kMostBuffers)) {
    auto content = neighbours(name);
    if (content && total + content->size() > kLargestMesh)
      content = fail(fmt::format("its buffers are larger than {} MiB together", kLargestMesh >> 20U));
    if (content) {
      total += content->size();
      out.found.emplace_back(name, std::move(*content));
    } else if (out.refusal.empty()) {
      out.refusal = content.error().what;
    }
  }
  return out;
}

Result<ScenePolygons> polygons_of(std::string_view bytes, std::string_view extension, const Eigen::Vector3d& scale,
                                  const Neighbours& neighbours, bool with_looks) {
  const Buffers buffers = find_buffers(bytes, extension, neighbours);
  MeshRequest request{extension, bytes, {}, scale, with_looks};
  request.buffers.assign(buffers.found.begin(), buffers.found.end());
  auto polygons = read_mesh_apart(request);
  if (!polygons && !buffers.refusal.empty()) return fail(buffers.refusal, "put it beside the mesh");
  return polygons;
}

// A file named in a mesh file: in the same folder, or below.
Result<std::string> read_neighbour(const fs::path& folder, const std::string& name) {
  std::error_code error;
  const fs::path wanted = fs::weakly_canonical(folder / name, error);
  const fs::path relative = error ? fs::path("..") : wanted.lexically_relative(folder);
  if (relative.empty() || *relative.begin() == ".." || !fs::is_regular_file(wanted, error))
    return fail(fmt::format("its buffer {} is missing", printable(name)));
  return read_text_file(wanted, kLargestMesh);
}

}  // namespace

Result<TriangleMesh> parse_mesh(std::string_view bytes, std::string_view extension, std::string name,
                                const Eigen::Vector3d& scale, const Neighbours& neighbours, MeshFindings& findings,
                                AppearanceRequest* looks) {
  findings = MeshFindings();
  const auto refuse = [&](const Error& error) {
    return fail(fmt::format("the mesh {} is refused: {}", name, error.what), error.remedy);
  };
  if (std::ranges::find(kFormats, extension) == kFormats.end()) return refuse({"its kind is unknown", {}});
  if (auto checked = check_mesh_bytes(bytes, extension); !checked) return refuse(checked.error());
  AppearanceRequest* const wanted = may_have_looks(extension) ? looks : nullptr;
  auto polygons = polygons_of(bytes, extension, scale, neighbours, wanted != nullptr);
  if (!polygons) return refuse(polygons.error());
  auto mesh = finish_mesh(std::move(*polygons), bytes, extension, name, findings, wanted);
  if (!mesh) return refuse(mesh.error());
  return mesh;
}

Result<TriangleMesh> read_mesh_file(const fs::path& file, const Eigen::Vector3d& scale, MeshFindings& findings,
                                    AppearanceRequest* looks) {
  const auto bytes = read_text_file(file, kLargestMesh);
  if (!bytes) return std::unexpected(bytes.error());
  const fs::path folder = file.parent_path();
  return parse_mesh(
      *bytes, lower_case(file.extension().string()), file.filename().string(), scale,
      [&](const std::string& name) { return read_neighbour(folder, name); }, findings, looks);
}

}  // namespace cellmirror
