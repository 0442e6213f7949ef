#include "app/new_cell/mesh_sources.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>
#include <system_error>

#include "app/new_cell/names.hpp"
#include "rt_core/base/home.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kPackage = "package://";
constexpr std::string_view kFile = "file://";
constexpr int kHighest = 8;  // folders above the URDF that are looked at
constexpr std::size_t kMostMeshes = 4096;
constexpr std::uintmax_t kMostBytes = 2ULL << 30U;  // of all copies

// Within `root`, which is canonical; `path` is, too.
bool is_within(const fs::path& path, const fs::path& root) {
  const fs::path relative = path.lexically_relative(root);
  return !relative.empty() && *relative.begin() != "..";
}

// The folders in a variable like PATH, each with `below`, as far as they exist.
void add_folders_of(const char* variable, const char* below, std::vector<fs::path>& folders) {
  const char* value = std::getenv(variable);
  std::string_view rest = value == nullptr ? std::string_view() : std::string_view(value);
  constexpr int kMost = 256;
  for (int i = 0; i < kMost && !rest.empty(); ++i) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    const fs::path folder = fs::path(rest.substr(0, end)) / below;
    rest.remove_prefix(std::min(end + 1, rest.size()));
    std::error_code error;
    const fs::path canonical = fs::canonical(folder, error);
    if (!error && folder.is_absolute() && fs::is_directory(canonical, error)) folders.push_back(canonical);
  }
}

// The path below a package or folder: relative, without a way out.
bool stays_below(const fs::path& path) {
  return !path.empty() && path.is_relative() && *path.begin() != ".." && *path.begin() != ".";
}

bool is_companion(const fs::path& file) {
  static constexpr std::array<std::string_view, 5> kKinds{".mtl", ".png", ".jpg", ".jpeg", ".bin"};
  return std::ranges::find(kKinds, lower_case(file.extension().string())) != kKinds.end();
}

// A path in the URDF of characters that need no quoting in XML.
std::string plain_path(const fs::path& path) {
  std::string out;
  for (const fs::path& part : path) out += (out.empty() ? "" : "/") + plain_file_name(part.string());
  return out;
}

}  // namespace

MeshSources::MeshSources(const fs::path& urdf, std::string folder, const fs::path& named_folder)
    : folder_(std::move(folder)) {
  if (!named_folder.empty() && named_folder != urdf.parent_path()) urdf_folders_.push_back(named_folder);
  urdf_folders_.push_back(urdf.parent_path());
  for (const fs::path& start : urdf_folders_) {
    roots_.push_back(start);
    std::error_code error;
    fs::path above = start;
    for (int i = 0; i < kHighest && above.has_relative_path(); ++i, above = above.parent_path()) {
      if (!fs::is_regular_file(above / "package.xml", error)) continue;
      roots_.push_back(above);
      break;
    }
  }
  add_folders_of("AMENT_PREFIX_PATH", "share", packages_);
  add_folders_of("ROS_PACKAGE_PATH", "", packages_);
}

// A file in a known folder, or a link there: colcon build --symlink-install makes links to the sources.
Result<fs::path> MeshSources::from_folders(const std::string& text) const {
  bool is_there = false;
  for (const fs::path& folder : urdf_folders_) {
    std::error_code error;
    const fs::path file = fs::canonical(folder / text, error);  // an absolute path stays as it is
    if (error) continue;
    is_there = true;
    const fs::path written = (folder / text).lexically_normal();
    const fs::path leads_to = fs::canonical(written, error);
    if (allowed(file) || (!error && leads_to == file && allowed(written))) return file;
  }
  if (!is_there) return fail(fmt::format("there is no file {}", printable(text)), "put it beside the URDF");
  return fail(fmt::format("the mesh {} lies outside of {} and of every known ROS package", printable(text),
                          urdf_folders_.front().string()),
              "put it beside the URDF");
}

bool MeshSources::allowed(const fs::path& file) const {
  const auto holds = [&](const fs::path& root) { return is_within(file, root); };
  return std::ranges::any_of(roots_, holds) || std::ranges::any_of(packages_, holds);
}

Result<fs::path> MeshSources::find(FileUse, std::string_view name) const {
  return fail(fmt::format("{} is not looked for here", printable(name)));
}

Result<MeshSources::Found> MeshSources::in_package(const std::string& name) const {
  const fs::path rest(name.substr(kPackage.size()));
  const std::string package = rest.empty() ? std::string() : rest.begin()->string();
  const fs::path inside = rest.lexically_relative(package).lexically_normal();
  if (!is_plain_name(package) || !stays_below(inside))
    return fail(fmt::format("{} names no file of a package", printable(name)));
  std::vector<fs::path> folders;
  for (const fs::path& start : urdf_folders_) {
    fs::path above = start;
    for (int i = 0; i < kHighest && above.has_relative_path(); ++i, above = above.parent_path()) {
      if (above.filename() == package) folders.push_back(above);
      folders.push_back(above / package);
    }
  }
  for (const fs::path& packages : packages_) {
    folders.push_back(packages / package);
    if (packages.filename() == package) folders.push_back(packages);
  }
  for (const fs::path& folder : folders) {
    std::error_code error;
    const fs::path root = fs::canonical(folder, error);
    if (error) continue;
    const fs::path file = fs::canonical(root / inside, error);
    if (error) continue;  // `inside` stays below the package; a link there may lead to its sources
    return Found{file, "robots/" + package + "/" + plain_path(inside),
                 std::string(kPackage) + package + "/" + plain_path(inside)};
  }
  return fail(fmt::format("there is no file {}", printable(name)),
              fmt::format("put the folder {} beside the URDF, or source ROS 2's setup.bash, which sets "
                          "AMENT_PREFIX_PATH",
                          printable(package)));
}

Result<MeshSources::Found> MeshSources::as_path(const std::string& name) const {
  std::string text = name;
  if (text.starts_with(kFile)) text.erase(0, kFile.size());
  if (text.find("://") != std::string::npos || text.empty())
    return fail(fmt::format("the mesh {} is not a file", printable(name)), "use a path relative to the URDF");
  const auto found = from_folders(text);
  if (!found) return std::unexpected(found.error());
  const fs::path& file = *found;
  const fs::path inside = fs::path(text).is_relative() ? fs::path(text).lexically_normal() : fs::path();
  if (stays_below(inside) && plain_path(inside) == inside.string())
    return Found{file, folder_ + "/" + inside.string(), name};
  // Its folder goes into the name, so that equal names of several folders stay apart.
  const std::string plain =
      "meshes/" + plain_file_name(file.parent_path().filename().string()) + "/" + plain_path(file.filename());
  return Found{file, folder_ + "/" + plain, plain};
}

Result<MeshSources::Found> MeshSources::resolve(const std::string& name) const {
  if (name.find('\0') != std::string::npos) return fail("the name of a mesh has a NUL");
  return name.starts_with(kPackage) ? in_package(name) : as_path(name);
}

Result<fs::path> MeshSources::find_mesh_of_urdf(const fs::path&, std::string_view name) const {
  const std::string text(name);
  if (const auto known = found_.find(text); known != found_.end()) return known->second.file;
  if (found_.size() >= kMostMeshes) return fail(fmt::format("the URDF names more than {} meshes", kMostMeshes));
  auto found = resolve(text);
  if (!found) return std::unexpected(found.error());
  std::error_code error;
  if (!fs::is_regular_file(found->file, error)) return fail(fmt::format("{} is not a file", printable(name)));
  const bool taken = std::ranges::any_of(
      found_, [&](const auto& other) { return other.second.to == found->to && other.second.file != found->file; });
  if (taken) {
    return fail(fmt::format("two meshes would be copied to {}", found->to), "rename one of them");
  }
  return found_.emplace(text, std::move(*found)).first->second.file;
}

// A name that occurs in the mesh's text is taken for that of a file beside it.
void MeshSources::add_companions(const Found& mesh, std::vector<PlannedFile>& files) const {
  const std::string extension = lower_case(mesh.file.extension().string());
  if (extension == ".stl" || extension == ".ply" || extension == ".glb") return;
  std::vector<fs::path> beside;
  std::error_code error;
  constexpr std::size_t kMostEntries = 4096;
  constexpr std::size_t kMostCompanions = 256;
  std::size_t seen = 0;
  for (fs::directory_iterator at(mesh.file.parent_path(), error), end;
       !error && at != end && seen < kMostEntries && beside.size() < kMostCompanions; at.increment(error), ++seen) {
    if (is_companion(at->path())) beside.push_back(at->path());
  }
  std::ranges::sort(beside);
  std::vector<fs::path> open{mesh.file};
  std::set<fs::path> done;
  while (!open.empty()) {
    const auto text = read_text_file(open.back(), kLargestMesh);
    open.pop_back();
    if (!text) continue;  // the check of the cell says what it lacks
    for (const fs::path& file : beside) {
      const std::string name = file.filename().string();
      if (text->find(name) == std::string::npos || !done.insert(file).second) continue;
      const fs::path canonical = fs::canonical(file, error);
      const bool is_beside = is_within(canonical, mesh.file.parent_path());  // also where the mesh is a link's target
      if (error || !(is_beside || allowed(canonical)) || !fs::is_regular_file(canonical, error)) continue;
      files.push_back({canonical, (fs::path(mesh.to).parent_path() / name).string(), {}});
      if (lower_case(file.extension().string()) == ".mtl") open.push_back(canonical);
    }
  }
}

Result<std::vector<PlannedFile>> MeshSources::files() const {
  std::vector<PlannedFile> files;
  for (const auto& [name, found] : found_) {
    files.push_back({found.file, found.to, {}});
    add_companions(found, files);
  }
  std::ranges::sort(files, {}, &PlannedFile::to);
  const auto again = std::ranges::unique(files, {}, &PlannedFile::to);
  files.erase(again.begin(), again.end());
  std::uintmax_t bytes = 0;
  for (const PlannedFile& file : files) {
    std::error_code error;
    bytes += fs::file_size(file.from, error);
    if (error || bytes > kMostBytes) return fail("the meshes of the robot have more than 2 GiB", "reduce them");
  }
  return files;
}

std::string MeshSources::rewritten(std::string text) const {
  for (const auto& [name, found] : found_) {
    if (found.name == name) continue;
    for (const char quote : {'"', '\''}) {
      const std::string from = quote + name + quote;
      const std::string to = quote + found.name + quote;
      for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
    }
  }
  return text;
}

}  // namespace cellmirror::app
