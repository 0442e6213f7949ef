#include "rt_core/base/home.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

#include "rt_core/base/descriptor.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace fs = std::filesystem;

namespace {

bool is_inside(const fs::path& path, const fs::path& root) {
  const auto [at_root, at_path] = std::mismatch(root.begin(), root.end(), path.begin(), path.end());
  static_cast<void>(at_path);
  return at_root == root.end();
}

Result<void> check_name(std::string_view name) {
  constexpr std::size_t kLongest = 512;
  const std::string shown = printable(name);
  if (name.empty()) return fail("the file name is empty");
  if (name.size() > kLongest) return fail(fmt::format("the file name {} is too long", shown));
  if (name.find('\0') != std::string_view::npos)
    return fail(fmt::format("the file name {} contains a NUL byte", shown));
  if (fs::path(name).is_absolute()) {
    return fail(fmt::format("the path {} is absolute", shown), "use a path relative to the cell folder");
  }
  return {};
}

// Names of the files in `folder`, as `name` is written: with its folders, and without an extension where it has none.
std::vector<std::string> files_beside(const fs::path& folder, const fs::path& name,
                                      std::span<const std::string_view> extensions) {
  constexpr std::size_t kMost = 512;  // entries examined at most, so that a refusal is cheap in a folder of any size
  const bool bare = name.extension().empty() && !extensions.empty();
  std::vector<std::string> names;
  std::error_code error;
  fs::directory_iterator entry(folder, error);
  for (std::size_t seen = 0; !error && entry != fs::directory_iterator() && seen < kMost; ++seen) {
    const fs::path file = entry->path().filename();
    const bool fits =
        extensions.empty() || std::ranges::find(extensions, file.extension().string()) != extensions.end();
    std::error_code unknown_kind;
    if (fits && entry->is_regular_file(unknown_kind))
      names.push_back(printable((name.parent_path() / (bare ? file.stem() : file)).string()));
    entry.increment(error);
  }
  std::ranges::sort(names);
  names.erase(std::ranges::unique(names).begin(), names.end());
  return names;
}

}  // namespace

Result<KismetHome> KismetHome::open(const fs::path& root) {
  std::error_code error;
  fs::path canonical = fs::canonical(root, error);
  if (error) return fail(fmt::format("the cell folder {} cannot be opened: {}", root.string(), error.message()));
  if (!fs::is_directory(canonical, error))
    return fail(fmt::format("the cell folder {} is not a folder", root.string()));
  return KismetHome(std::move(canonical));
}

Result<KismetHome> KismetHome::of_cell(const fs::path& cell_file) {
  const char* from_environment = std::getenv("kis_home");
  if (from_environment != nullptr && *from_environment != '\0') return open(from_environment);
  const fs::path folder = cell_file.parent_path();
  return open(folder.empty() ? fs::path(".") : folder);
}

Result<KismetHome> KismetHome::with_state(const fs::path& state) const {
  std::error_code error;
  fs::create_directories(state, error);
  if (error) return fail(fmt::format("the state folder {} cannot be created: {}", state.string(), error.message()));
  fs::path canonical = fs::canonical(state, error);
  if (error) return fail(fmt::format("the state folder {} cannot be opened: {}", state.string(), error.message()));
  if (!fs::is_directory(canonical, error))
    return fail(fmt::format("the state folder {} is not a folder", state.string()));
  KismetHome out = *this;
  out.state_ = std::move(canonical);
  return out;
}

const fs::path& KismetHome::root_of(std::string_view folder, std::string_view name, std::string_view extension) const {
  if (state_.empty()) return root_;
  std::error_code error;
  fs::path written = state_ / folder / name;
  if (fs::exists(written, error)) return state_;
  if (written.has_extension()) return root_;
  written += extension;
  return fs::exists(written, error) ? state_ : root_;
}

bool KismetHome::has(std::string_view folder, std::string_view name) const {
  std::error_code error;
  const fs::path path = root_of(folder, name, {}) / folder / name;
  return fs::exists(path, error) && !fs::is_directory(path, error);
}

std::string KismetHome::shown_name(const fs::path& file) const {
  const bool written = !state_.empty() && is_inside(file, state_);
  return file.lexically_relative(written ? state_ : root_).string();
}

Result<fs::path> KismetHome::file(std::string_view folder, std::string_view name, std::string_view extension) const {
  return find(folder, name, extension, false);
}

Result<fs::path> KismetHome::file_or_folder(std::string_view folder, std::string_view name) const {
  return find(folder, name, {}, true);
}

Result<fs::path> KismetHome::find(std::string_view folder, std::string_view name, std::string_view extension,
                                  bool folders) const {
  if (auto named = check_name(name); !named) return std::unexpected(named.error());
  std::error_code error;
  const fs::path& root = root_of(folder, name, extension);
  fs::path wanted = root / folder / name;
  const bool extended = !extension.empty() && wanted.extension().empty() && !fs::exists(wanted, error);
  if (extended) wanted += extension;
  const fs::path found = fs::canonical(wanted, error);
  const std::string shown = (fs::path(folder) / printable(name)).string() + std::string(extended ? extension : "");
  if (error == std::errc::no_such_file_or_directory) {
    const std::span<const std::string_view> extensions(&extension, extension.empty() ? 0 : 1);
    return fail(fmt::format("the file {} does not exist in the cell folder {}", shown, root_.string()),
                nearest_files(folder, name, extensions));
  }
  if (error) return fail(fmt::format("the file {} cannot be opened: {}", shown, error.message()));
  if (!is_inside(found, root)) {
    return fail(fmt::format("the path {} leaves the cell folder {}", shown, root.string()),
                "put the file into the cell folder");
  }
  if (fs::is_directory(found, error)) {
    if (folders) return found;
    return fail(fmt::format("{} is a folder, not a file", shown));
  }
  if (!fs::is_regular_file(found, error)) return fail(fmt::format("{} is not a regular file", shown));
  if (access(found.c_str(), R_OK) != 0)
    return fail(fmt::format("the file {} is not readable: {}", shown, std::strerror(errno)));
  return found;
}

std::string KismetHome::nearest_files(std::string_view folder, std::string_view name,
                                      std::span<const std::string_view> extensions) const {
  if (!check_name(name)) return {};
  std::error_code error;
  const fs::path place = fs::canonical((root_ / folder / name).parent_path(), error);
  if (error || !is_inside(place, root_)) return {};
  return did_you_mean(name, files_beside(place, name, extensions));
}

Result<fs::path> KismetHome::file_to_write(std::string_view folder, std::string_view name) const {
  if (auto named = check_name(name); !named) return std::unexpected(named.error());
  if (name.find('/') != std::string_view::npos || name == "." || name == "..") {
    return fail(fmt::format("{} is not a plain file name", printable(name)), "give a name without folders");
  }
  std::error_code error;
  const fs::path& root = state_.empty() ? root_ : state_;
  const fs::path parent = root / folder;
  fs::create_directories(parent, error);
  if (error) return fail(fmt::format("the folder {} cannot be created: {}", parent.string(), error.message()));
  const fs::path canonical_parent = fs::canonical(parent, error);
  if (error || !is_inside(canonical_parent, root))
    return fail(fmt::format("the path {} leaves the cell folder", parent.string()));
  const fs::path target = canonical_parent / name;
  const fs::file_status status = fs::symlink_status(target, error);
  if (fs::exists(status) && !fs::is_regular_file(status))
    return fail(fmt::format("{} exists and is not a regular file", target.string()));
  return target;
}

Result<std::string> read_text_file(const fs::path& path, std::size_t limit) {
  // O_NONBLOCK: opening a FIFO in place of a file must not wait for its writer.
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!file.valid()) return fail(fmt::format("{} cannot be opened: {}", path.string(), std::strerror(errno)));
  struct stat info{};
  if (fstat(file.get(), &info) != 0)
    return fail(fmt::format("{} cannot be read: {}", path.string(), std::strerror(errno)));
  if (S_ISDIR(info.st_mode)) return fail(fmt::format("{} is a folder, not a file", path.string()));
  if (!S_ISREG(info.st_mode)) return fail(fmt::format("{} is not a regular file", path.string()));
  if (static_cast<std::size_t>(info.st_size) > limit) {
    return fail(fmt::format("{} has {} bytes, more than the limit of {}", path.string(), info.st_size, limit));
  }
  std::string text(static_cast<std::size_t>(info.st_size), '\0');
  std::size_t filled = 0;
  while (filled < text.size()) {
    const ssize_t got = ::read(file.get(), text.data() + filled, text.size() - filled);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return fail(fmt::format("{} cannot be read: {}", path.string(), std::strerror(errno)));
    if (got == 0) break;
    filled += static_cast<std::size_t>(got);
  }
  text.resize(filled);
  return text;
}

}  // namespace cellmirror
