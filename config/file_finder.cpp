#include "config/file_finder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <system_error>
#include <utility>

#include "config/mesh_check.hpp"
#include "config/msh/msh_file.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kPackage = "package://";
constexpr std::string_view kFile = "file://";

const char* folder_of(FileUse use, std::string_view name) {
  switch (use) {
    case FileUse::component:
      return equal_ignoring_case(fs::path(name).extension().string(), ".urdf") ? "robots" : "envlib";
    case FileUse::mesh:
    case FileUse::object:
    case FileUse::hyper:
      return "envlib";
    case FileUse::description:
      return "robots";
    case FileUse::script:
      return "scripts";
    case FileUse::log:
    case FileUse::layout:
    case FileUse::security:
      return "";
  }
  return "";
}

const char* default_extension(FileUse use) {
  switch (use) {
    case FileUse::script:
      return ".spt";
    case FileUse::layout:
      return ".lay";
    case FileUse::object:
      return ".mpo";
    case FileUse::hyper:
      return ".hyper";
    default:
      return "";
  }
}

// `path` relative to `root`, if it is within it.
std::string below(const fs::path& root, const fs::path& path) {
  const fs::path relative = path.lexically_relative(root);
  if (relative.empty() || *relative.begin() == "..") return {};
  return relative.string();
}

// The folders searched for a package: those above the URDF (up to `root`), and robots/ in the cell folder.
Result<fs::path> find_in_package(const KismetHome& root, const fs::path& urdf, std::string_view rest) {
  const std::size_t slash = rest.find('/');
  if (slash == std::string_view::npos || slash == 0)
    return fail(fmt::format("package://{} names a missing file", printable(rest)));
  const fs::path package(rest.substr(0, slash));
  const fs::path inside(rest.substr(slash + 1));
  fs::path folder = urdf.parent_path();
  constexpr int kHighest = 8;
  for (int i = 0; i < kHighest; ++i) {
    const std::string here = below(root.root(), folder);
    if (here.empty()) break;
    for (const fs::path& base : {folder.filename() == package ? folder : fs::path(), folder / package}) {
      if (base.empty()) continue;
      if (auto found = root.file("", below(root.root(), (base / inside).lexically_normal()))) return found;
    }
    if (here == ".") break;
    folder = folder.parent_path();
  }
  if (auto found = root.file("robots", (package / inside).string())) return found;
  return fail(fmt::format("there is no file package://{} above the URDF or in robots/", printable(rest)),
              fmt::format("put the folder {} beside the URDF", printable(package.string())));
}

}  // namespace

Result<fs::path> HomeFiles::find(FileUse use, std::string_view name) const {
  auto found = home_.file(folder_of(use, name), name, default_extension(use));
  return use == FileUse::security ? found : noted(std::move(found));
}

Result<fs::path> HomeFiles::noted(Result<fs::path> found) const {
  if (found) found_->note(*found);
  return found;
}

// The reader of meshes takes them from the folder of the mesh.
void HomeFiles::note_buffers(const fs::path& gltf) const {
  constexpr std::size_t kMostBuffers = 16;
  const auto text = read_text_file(gltf, kLargestMesh);
  if (!text) return;
  std::error_code error;
  for (const std::string& name : gltf_buffer_files(*text, kMostBuffers)) {
    const fs::path file = fs::weakly_canonical(gltf.parent_path() / name, error);
    if (!error && !below(gltf.parent_path(), file).empty() && fs::is_regular_file(file, error)) found_->note(file);
  }
}

Result<void> FileFinder::check_private(const fs::path& /*file*/) const { return {}; }

Result<void> HomeFiles::check_private(const fs::path& file) const {
  std::error_code error;
  const fs::perms mode = fs::status(file, error).permissions();
  if (error) return fail(fmt::format("{}: {}", file.string(), error.message()));
  if ((mode & (fs::perms::group_all | fs::perms::others_all)) == fs::perms::none) return {};
  return fail(fmt::format("{} is accessible to others (mode {:04o})", file.string(), static_cast<unsigned>(mode)),
              fmt::format("chmod 600 {}", file.string()));
}

Result<fs::path> HomeFiles::find_mesh_of_urdf(const fs::path& urdf, std::string_view name) const {
  return noted(find_named_in(urdf, "URDF", name, "mesh"));
}

Result<fs::path> HomeFiles::find_named_in(const fs::path& file, std::string_view kind, std::string_view name,
                                          std::string_view what) const {
  const std::string remedy = fmt::format("use a path relative to the {}", kind);
  std::error_code error;
  const fs::path at = fs::weakly_canonical(file, error);
  if (error) return fail(fmt::format("{} cannot be opened: {}", file.string(), error.message()));
  const bool in_home = !below(home_.root(), at).empty();
  auto root = in_home ? Result<KismetHome>(home_) : KismetHome::open(at.parent_path());
  if (!root) return std::unexpected(root.error());
  if (name.starts_with(kPackage)) return find_in_package(*root, at, name.substr(kPackage.size()));
  if (name.starts_with(kFile)) name.remove_prefix(kFile.size());
  if (name.find("://") != std::string_view::npos)
    return fail(fmt::format("the {} {} is not a file", what, printable(name)), remedy);
  if (fs::path(name).is_absolute()) return fail(fmt::format("the path {} is absolute", printable(name)), remedy);
  const fs::path wanted = (at.parent_path() / name).lexically_normal();
  const std::string inside = below(root->root(), wanted);
  if (inside.empty() || name.empty()) {
    return fail(fmt::format("the path {} leaves {}", printable(name), root->root().string()),
                fmt::format("put the {} beside the {}", what, kind));
  }
  return root->file("", inside);
}

Result<CollisionMesh> FileFinder::mesh(const fs::path&, const Eigen::Vector3d&, std::optional<CollideAs>, const Place&,
                                       Diagnostics&) const {
  return CollisionMesh{};
}

Result<CollisionMesh> HomeFiles::mesh(const fs::path& file, const Eigen::Vector3d& scale,
                                      std::optional<CollideAs> collide_as, const Place& place,
                                      Diagnostics& diagnostics) const {
  const auto beside = [&](const std::string& name) { return noted(find_named_in(file, "mesh", name, "picture")); };
  if (!meshes_->is_counting() && equal_ignoring_case(file.extension().string(), ".gltf")) note_buffers(file);
  return meshes_->mesh(file, scale, collide_as.value_or(CollideAs::exact), beside, place, diagnostics);
}

std::optional<tissue::TetraMesh> FileFinder::tetrahedra(const fs::path&, double, Diagnostics&) const {
  return tissue::TetraMesh();
}

std::optional<tissue::TetraMesh> HomeFiles::tetrahedra(const fs::path& file, double scale,
                                                       Diagnostics& diagnostics) const {
  meshes_->about_to_read(file);
  return msh::read_msh(file, scale, diagnostics);
}

std::shared_ptr<const VolumeData> FileFinder::volume(const VolumeRequest&, const Place&, Diagnostics&) const {
  return std::make_shared<const VolumeData>();
}

std::shared_ptr<const VolumeData> HomeFiles::volume(const VolumeRequest& request, const Place& place,
                                                    Diagnostics& diagnostics) const {
  const auto found = home_.file_or_folder("envlib", request.source);
  if (!found) {
    diagnostics.error(place, found.error().what, found.error().remedy);
    return nullptr;
  }
  auto volume = volumes_->volume(*found, request, place, diagnostics);
  std::error_code error;
  const bool is_folder = fs::is_directory(*found, error);
  if (!is_folder) found_->note(*found);
  if (!volume) return volume;
  for (const std::string& name : volume->facts.files) {
    const fs::path file = fs::weakly_canonical((is_folder ? *found : found->parent_path()) / name, error);
    if (!error && fs::is_regular_file(file, error)) found_->note(file);
  }
  return volume;
}

Result<fs::path> AnyFile::find(FileUse, std::string_view name) const { return fs::path("/") / fs::path(name); }

Result<fs::path> AnyFile::find_mesh_of_urdf(const fs::path&, std::string_view name) const {
  return fs::path("/") / fs::path(name);
}

Result<void> check_mesh(const fs::path& file) {
  static constexpr std::array<std::string_view, 6> kKinds{".stl", ".obj", ".dae", ".ply", ".gltf", ".glb"};
  const std::string extension = lower_case(file.extension().string());
  if (std::ranges::find(kKinds, extension) == kKinds.end()) {
    return fail(fmt::format("{} is not a mesh file", file.filename().string()),
                "meshes are .stl, .obj, .dae, .ply, .gltf or .glb");
  }
  std::error_code error;
  const auto size = fs::file_size(file, error);
  if (error) return {};  // AnyFile's names are on no disk; real ones were opened when they were found
  if (size == 0) return fail(fmt::format("the mesh {} is empty", file.filename().string()));
  if (size > kLargestMesh) {
    return fail(fmt::format("the mesh {} has {} bytes, more than {}", file.filename().string(), size, kLargestMesh),
                "reduce it");
  }
  return {};
}

}  // namespace cellmirror
