#include "ipc/runtime/ipc_owner.hpp"

#include <fmt/format.h>
#include <pwd.h>
#include <sys/stat.h>

#include <array>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>
#include <vector>

namespace cellmirror {

namespace {

const char* table_file(IpcKind kind) {
  switch (kind) {
    case IpcKind::queue:
      return "/proc/sysvipc/msg";
    case IpcKind::memory:
      return "/proc/sysvipc/shm";
    case IpcKind::semaphore:
      return "/proc/sysvipc/sem";
  }
  return "";
}

// Column of the owner; the group follows, then the creator.
std::size_t owner_column(IpcKind kind) {
  switch (kind) {
    case IpcKind::queue:
    case IpcKind::memory:
      return 7;
    case IpcKind::semaphore:
      return 4;
  }
  return 0;
}

std::optional<std::int64_t> number(const std::vector<std::string>& columns, std::size_t at) {
  if (at >= columns.size()) return std::nullopt;
  std::int64_t value = 0;
  const std::string& text = columns[at];
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

}  // namespace

std::optional<IpcOwner> find_ipc_owner(std::string_view table, IpcKind kind, std::int32_t key) {
  std::istringstream lines{std::string(table)};
  std::string line;
  std::getline(lines, line);  // the headings
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    const std::vector<std::string> columns{std::istream_iterator<std::string>(words), {}};
    const auto found = number(columns, 0);
    const auto id = number(columns, 1);
    const auto owner = number(columns, owner_column(kind));
    const auto creator = number(columns, owner_column(kind) + 2);
    if (!found || !id || !owner || !creator) continue;
    // The kernel prints keys with a sign.
    if (static_cast<std::int32_t>(*found) != key) continue;
    return IpcOwner{key, static_cast<std::int32_t>(*id), static_cast<uid_t>(*owner), static_cast<uid_t>(*creator)};
  }
  return std::nullopt;
}

std::optional<IpcOwner> ipc_owner(IpcKind kind, std::int32_t key) {
  return find_ipc_owner(text_of(table_file(kind)), kind, key);
}

std::string user_text(uid_t user) {
  passwd entry{};
  passwd* found = nullptr;
  std::array<char, 4096> buffer{};
  const bool known = ::getpwuid_r(user, &entry, buffer.data(), buffer.size(), &found) == 0 && found != nullptr;
  return known ? fmt::format("user {} (uid {})", entry.pw_name, user) : fmt::format("uid {}", user);
}

std::string remove_command(IpcKind kind, std::int32_t id) {
  const char letter = kind == IpcKind::queue ? 'q' : kind == IpcKind::memory ? 'm' : 's';
  return fmt::format("ipcrm -{} {}", letter, id);
}

pid_t gateway_process_of(uid_t user) {
  std::error_code error;
  for (std::filesystem::directory_iterator at("/proc", error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename();
    pid_t process = 0;
    const auto [last, failed] = std::from_chars(name.data(), name.data() + name.size(), process);
    if (failed != std::errc() || last != name.data() + name.size()) continue;
    struct stat folder{};
    if (::stat(at->path().c_str(), &folder) != 0 || folder.st_uid != user) continue;
    if (text_of(at->path() / "comm") == "cellmirror\n") return process;
  }
  return 0;
}

}  // namespace cellmirror
