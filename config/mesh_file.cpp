// assimp stays in this file: nothing that it throws, logs or opens gets out.
#include "config/mesh_file.hpp"

#include <assimp/BaseImporter.h>
#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cstring>
#include <exception>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "config/file_finder.hpp"
#include "config/mesh_check.hpp"
#include "config/mesh_looks.hpp"
#include "config/mesh_scene.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace fs = std::filesystem;
using geometry::MeshFindings;
using geometry::TriangleMesh;

namespace {

struct Format {
  std::string_view extension;
  std::string_view importer;  // by the name that assimp gives it
};
constexpr std::array<Format, 6> kFormats{{{".stl", "Stereolithography (STL) Importer"},
                                          {".obj", "Wavefront Object Importer"},
                                          {".dae", "Collada Importer"},
                                          {".ply", "Stanford Polygon Library (PLY) Importer"},
                                          {".gltf", "glTF2 Importer"},
                                          {".glb", "glTF2 Importer"}}};

class MemoryStream final : public Assimp::IOStream {
 public:
  explicit MemoryStream(std::string_view bytes) : bytes_(bytes) {}
  explicit MemoryStream(std::string owned) : owned_(std::move(owned)), bytes_(owned_) {}

  std::size_t Read(void* to, std::size_t size, std::size_t count) override {
    if (size == 0) return 0;
    const std::size_t whole = std::min(count, (bytes_.size() - at_) / size);
    std::memcpy(to, bytes_.data() + at_, whole * size);
    at_ += whole * size;
    return whole;
  }
  std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin origin) override {
    const std::size_t base = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? at_ : bytes_.size();
    if (offset > bytes_.size() - base) return aiReturn_FAILURE;
    at_ = base + offset;
    return aiReturn_SUCCESS;
  }
  [[nodiscard]] std::size_t Tell() const override { return at_; }
  [[nodiscard]] std::size_t FileSize() const override { return bytes_.size(); }
  void Flush() override {}

 private:
  std::string owned_;
  std::string_view bytes_;
  std::size_t at_ = 0;
};

// The file from memory; of others only the buffers of glTF.
class Files final : public Assimp::IOSystem {
 public:
  Files(std::string main, std::string_view bytes, const Neighbours& neighbours)
      : main_(std::move(main)), bytes_(bytes), neighbours_(neighbours) {}

  bool Exists(const char* name) const override { return name == main_ || is_buffer(name); }
  [[nodiscard]] char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char* mode) override {
    if (std::strchr(mode, 'w') != nullptr) return nullptr;
    if (name == main_) return new MemoryStream(bytes_);
    if (!is_buffer(name) || !neighbours_ || opened_ >= kMostBuffers) return nullptr;
    ++opened_;
    auto content = neighbours_(std::string(name).substr(std::string_view(name).starts_with("./") ? 2 : 0));
    if (content) return new MemoryStream(std::move(*content));
    if (refusal_.empty()) refusal_ = content.error().what;
    return nullptr;
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }
  // Why a neighbour was not opened.
  [[nodiscard]] const std::string& refusal() const { return refusal_; }

 private:
  static constexpr int kMostBuffers = 16;
  [[nodiscard]] bool is_buffer(std::string_view name) const {
    return main_.ends_with(".gltf") && name.ends_with(".bin");
  }

  std::string main_;
  std::string_view bytes_;
  const Neighbours& neighbours_;
  std::string refusal_;
  int opened_ = 0;
};

// An importer of that one format.
void keep_only(Assimp::Importer& importer, std::string_view name) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    const aiImporterDesc* description = importer.GetImporterInfo(i);
    if (description != nullptr && name == description->mName) continue;
    const std::unique_ptr<Assimp::BaseImporter> gone(importer.GetImporter(i));
    importer.UnregisterLoader(gone.get());
  }
}

struct Imported {
  ScenePolygons polygons;
  std::optional<std::vector<MeshMaterial>> palette;  // where there is a look
};

// STL has no colours that two programs would agree on.
bool may_have_looks(std::string_view extension) { return extension != ".stl"; }

// `looks` null: shapes alone.
Result<Imported> import(std::string_view bytes, const Format& format, const Eigen::Vector3d& scale,
                        const Neighbours& neighbours, LookRequest* looks) {
  Assimp::Importer importer;
  keep_only(importer, format.importer);
  if (importer.GetImporterCount() == 0) return fail(fmt::format("this build reads no {} files", format.extension));
  const std::string name = fmt::format("mesh{}", format.extension);
  auto* files = new Files(name, bytes, neighbours);  // the importer owns it
  importer.SetIOHandler(files);
  // As ROS does: coordinates as they stand in the file, whatever up_axis says; its unit counts.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  const aiScene* scene = importer.ReadFile(name, aiProcess_ValidateDataStructure);
  if (!files->refusal().empty()) return fail(files->refusal(), "put it beside the mesh");
  if (scene == nullptr || scene->mRootNode == nullptr)
    return fail(fmt::format("it cannot be read: {}", printable(std::string(importer.GetErrorString()))));
  auto polygons = collect_polygons(*scene, scale, looks != nullptr);
  if (!polygons) return std::unexpected(polygons.error());
  Imported out{std::move(*polygons), std::nullopt};
  if (looks == nullptr) return out;
  if (format.extension == ".obj") name_obj_pictures(bytes, *looks, out.polygons);
  // Those of DAE were decoded by assimp.
  if (format.extension == ".gltf" || format.extension == ".glb") decode_picture_names(out.polygons);
  out.palette = load_palette(out.polygons, *looks);
  out.polygons.embedded.clear();
  return out;
}

Result<TriangleMesh> make(const std::string& name, Imported from, MeshFindings& findings, LookRequest* looks) {
  ScenePolygons& polygons = from.polygons;
  if (!from.palette)
    return geometry::make_mesh(name, std::move(polygons.vertices), std::move(polygons.triangles), findings);
  std::vector<std::uint32_t> origins;
  auto mesh = geometry::make_mesh(name, polygons.vertices, polygons.triangles, findings, &origins);
  if (mesh)
    looks->look = std::make_shared<const MeshLook>(lay_over(*mesh, origins, polygons, std::move(*from.palette)));
  return mesh;
}

// A file named in a mesh file: in the same folder, or below.
Result<std::string> read_neighbour(const fs::path& folder, const std::string& name) {
  std::error_code error;
  const fs::path wanted = fs::weakly_canonical(folder / name, error);
  const fs::path relative = error ? fs::path("..") : wanted.lexically_relative(folder);
  if (relative.empty() || *relative.begin() == ".." || !fs::is_regular_file(wanted, error))
    return fail(fmt::format("its buffer {} is not there", printable(name)));
  return read_text_file(wanted, kLargestMesh);
}

}  // namespace

Result<TriangleMesh> parse_mesh(std::string_view bytes, std::string_view extension, std::string name,
                                const Eigen::Vector3d& scale, const Neighbours& neighbours, MeshFindings& findings,
                                LookRequest* looks) {
  findings = MeshFindings();
  const auto* const format = std::ranges::find(kFormats, extension, &Format::extension);
  const auto refuse = [&](const Error& error) {
    return fail(fmt::format("the mesh {} is refused: {}", name, error.what), error.remedy);
  };
  if (format == kFormats.end()) return refuse({"its kind is not known", {}});
  if (auto checked = check_mesh_bytes(bytes, extension); !checked) return refuse(checked.error());
  try {
    auto imported = import(bytes, *format, scale, neighbours, may_have_looks(extension) ? looks : nullptr);
    if (!imported) return refuse(imported.error());
    auto mesh = make(name, std::move(*imported), findings, looks);
    if (!mesh) return refuse(mesh.error());
    return mesh;
  } catch (const std::exception& exception) {
    return refuse({fmt::format("it cannot be read: {}", printable(std::string(exception.what()))), {}});
  } catch (...) {
    return refuse({"it cannot be read", {}});
  }
}

Result<TriangleMesh> read_mesh_file(const fs::path& file, const Eigen::Vector3d& scale, MeshFindings& findings,
                                    LookRequest* looks) {
  const auto bytes = read_text_file(file, kLargestMesh);
  if (!bytes) return std::unexpected(bytes.error());
  const fs::path folder = file.parent_path();
  return parse_mesh(
      *bytes, lower_case(file.extension().string()), file.filename().string(), scale,
      [&](const std::string& name) { return read_neighbour(folder, name); }, findings, looks);
}

}  // namespace cellmirror
