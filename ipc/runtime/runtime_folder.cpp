#include "ipc/runtime/runtime_folder.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <optional>
#include <string>

#include "ipc/runtime/system_error.hpp"

namespace cellmirror {
namespace {

std::optional<std::string> environment(const char* name) {
  const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): the environment is not changed
  if (value == nullptr || *value == '\0') return std::nullopt;
  return std::string(value);
}

constexpr const char* kOtherFolder = "set CELLMIRROR_RUNTIME_DIR to a folder of your own";

Result<void> check_kind(const std::filesystem::path& folder, const struct stat& found) {
  if (S_ISLNK(found.st_mode))
    return fail(fmt::format("the runtime folder {} is a link", folder.native()), kOtherFolder);
  if (!S_ISDIR(found.st_mode)) return fail(fmt::format("{} is not a folder", folder.native()), kOtherFolder);
  return {};
}

}  // namespace

Result<std::filesystem::path> runtime_folder_path() {
  if (const auto ours = environment("CELLMIRROR_RUNTIME_DIR")) {
    const std::filesystem::path folder(*ours);
    if (!folder.is_absolute()) {
      return fail(fmt::format("CELLMIRROR_RUNTIME_DIR is {}, which is not an absolute path", *ours), "begin it with /");
    }
    return folder;
  }
  if (const auto user = environment("XDG_RUNTIME_DIR")) {
    const std::filesystem::path folder(*user);
    // The XDG specification has relative ones ignored.
    if (folder.is_absolute()) return folder / "cellmirror";
  }
  if (::geteuid() == 0) return std::filesystem::path("/run/cellmirror");
  return std::filesystem::path(fmt::format("/tmp/cellmirror-{}", ::geteuid()));
}

Result<void> make_private_folder(const std::filesystem::path& folder) {
  if (::mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST) {
    return fail(fmt::format("cannot create the runtime folder {}: {}", folder.native(), system_error_text(errno)),
                kOtherFolder);
  }
  struct stat found{};
  if (::lstat(folder.c_str(), &found) != 0) {
    return fail(fmt::format("cannot read the runtime folder {}: {}", folder.native(), system_error_text(errno)),
                kOtherFolder);
  }
  if (const auto kind = check_kind(folder, found); !kind) return kind;
  if (found.st_uid != ::geteuid()) {
    return fail(fmt::format("the runtime folder {} belongs to user {}", folder.native(), found.st_uid), kOtherFolder);
  }
  if ((found.st_mode & 0077u) != 0) {
    return fail(fmt::format("other users have access to the runtime folder {} (mode {:o})", folder.native(),
                            found.st_mode & 0777u),
                fmt::format("chmod 700 {}", folder.native()));
  }
  return {};
}

Result<std::filesystem::path> runtime_folder() {
  auto folder = runtime_folder_path();
  if (!folder) return folder;
  if (const auto made = make_private_folder(*folder); !made) return std::unexpected(made.error());
  return folder;
}

Result<std::filesystem::path> runtime_folder_for_client() {
  auto folder = runtime_folder_path();
  if (!folder) return folder;
  struct stat found{};
  if (::lstat(folder->c_str(), &found) != 0) return folder;
  if (const auto kind = check_kind(*folder, found); !kind) return std::unexpected(kind.error());
  const uid_t me = ::geteuid();
  if (me != 0 && found.st_uid != me && found.st_uid != 0) {
    return fail(fmt::format("the runtime folder {} belongs to user {}, whose gateway is not trusted", folder->native(),
                            found.st_uid),
                kOtherFolder);
  }
  return folder;
}

}  // namespace cellmirror
