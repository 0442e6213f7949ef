#include "config/mesh_reader/mesh_importer.hpp"

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
#include <utility>

#include "config/mesh_message/stl_text.hpp"
#include "config/mesh_reader/mesh_scene.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

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
  std::string_view bytes_;
  std::size_t at_ = 0;
};

// The file and its buffers, all in memory.
class Files final : public Assimp::IOSystem {
 public:
  Files(std::string main, const MeshRequest& request) : main_(std::move(main)), request_(request) {}

  bool Exists(const char* name) const override { return name == main_ || buffer(name) != nullptr; }
  [[nodiscard]] char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char* mode) override {
    if (std::strchr(mode, 'w') != nullptr) return nullptr;
    if (name == main_) return new MemoryStream(request_.bytes);
    const std::string_view* content = buffer(name);
    return content == nullptr ? nullptr : new MemoryStream(*content);
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  // By its name in the file, before which assimp puts the folder of the file.
  [[nodiscard]] const std::string_view* buffer(std::string_view name) const {
    const auto with_name = [&](std::string_view wanted) {
      return std::ranges::find(request_.buffers, wanted, [](const auto& known) { return known.first; });
    };
    auto at = with_name(name);
    if (at == request_.buffers.end() && name.starts_with("./")) at = with_name(name.substr(2));
    return at == request_.buffers.end() ? nullptr : &at->second;
  }

  std::string main_;
  const MeshRequest& request_;
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

}  // namespace

Result<ScenePolygons> import_mesh(const MeshRequest& given) {
  MeshRequest request = given;
  const auto plain = given.extension == ".stl" ? plain_stl_text(given.bytes) : std::nullopt;
  if (plain) request.bytes = *plain;
  const auto* const format = std::ranges::find(kFormats, request.extension, &Format::extension);
  if (format == kFormats.end()) return fail("its kind is unknown");
  Assimp::Importer importer;
  keep_only(importer, format->importer);
  if (importer.GetImporterCount() == 0) return fail(fmt::format("this build reads no {} files", format->extension));
  const std::string name = fmt::format("mesh{}", format->extension);
  importer.SetIOHandler(new Files(name, request));  // the importer owns it
  // As in ROS: coordinates as in the file, regardless of up_axis; its unit applies.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  // Cameras and lights are not needed, and what is wrong with them must not refuse the mesh: they go before the check.
  importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_CAMERAS | aiComponent_LIGHTS);
  const aiScene* scene = importer.ReadFile(name, 0);
  if (scene != nullptr) scene = importer.ApplyPostProcessing(aiProcess_RemoveComponent);
  if (scene != nullptr) scene = importer.ApplyPostProcessing(aiProcess_ValidateDataStructure);
  if (const std::exception_ptr& thrown = importer.GetException(); thrown) {
    try {
      std::rethrow_exception(thrown);
    } catch (const std::bad_alloc&) {
      throw;
    } catch (...) {  // NOLINT(bugprone-empty-catch): GetErrorString() returns its text
    }
  }
  if (scene == nullptr || scene->mRootNode == nullptr)
    return fail(fmt::format("it cannot be read: {}", printable(std::string(importer.GetErrorString()))));
  return collect_polygons(*scene, request.scale, request.with_looks);
}

}  // namespace cellmirror
