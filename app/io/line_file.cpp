#include "app/io/line_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace cellmirror::app {

namespace {

constexpr mode_t kOwnerOnly = 0600;

std::unexpected<std::string> errno_text() { return std::unexpected<std::string>(std::strerror(errno)); }

}  // namespace

std::expected<LineFile, std::string> open_line_file(const std::filesystem::path& file) {
  Descriptor out(::open(file.c_str(), O_RDWR | O_APPEND | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, kOwnerOnly));
  if (!out.valid()) return errno_text();
  struct stat info{};
  if (::fstat(out.get(), &info) != 0) return errno_text();
  if (!S_ISREG(info.st_mode) || info.st_nlink > 1)
    return std::unexpected<std::string>("it is no plain file with one name");
  if (info.st_uid != ::geteuid()) return std::unexpected<std::string>("it belongs to another user");
  if (::fchmod(out.get(), kOwnerOnly) != 0) return errno_text();
  auto bytes = static_cast<std::uint64_t>(info.st_size);
  // A killed gateway may have left half a line.
  char last = '\n';
  if (bytes > 0 && ::pread(out.get(), &last, 1, info.st_size - 1) == 1 && last != '\n' && write_all(out.get(), "\n"))
    ++bytes;
  return LineFile{std::move(out), bytes};
}

bool write_all(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(file, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

std::string tail_of(const std::filesystem::path& file, std::size_t most_bytes) {
  const Descriptor in(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  struct stat info{};
  if (!in.valid() || ::fstat(in.get(), &info) != 0 || !S_ISREG(info.st_mode)) return {};
  const off_t size = info.st_size;
  const off_t from = std::max<off_t>(0, size - static_cast<off_t>(most_bytes));
  std::string text(static_cast<std::size_t>(size - from), '\0');
  const ssize_t got = ::pread(in.get(), text.data(), text.size(), from);
  text.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  return text;
}

}  // namespace cellmirror::app
