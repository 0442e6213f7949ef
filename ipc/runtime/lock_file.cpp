#include "ipc/runtime/lock_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <string_view>
#include <thread>
#include <utility>

#include "ipc/runtime/system_error.hpp"
#include "rt_core/base/descriptor.hpp"

namespace cellmirror {
namespace {

// Retries if the file names no holder, i.e. while another process only checks the lock, or is about to write.
constexpr int kTries = 50;
constexpr std::chrono::milliseconds kBetweenTries{2};

LockFile::Refused failed(const std::filesystem::path& path, std::string_view what, int error_number) {
  return {LockFile::Refusal::failed,
          {},
          Error{fmt::format("cannot {} the lock {}: {}", what, path.native(), system_error_text(error_number)),
                "set CELLMIRROR_RUNTIME_DIR to a folder of your own"}};
}

// "<pid> <note>\n"
LockHolder read_holder(int fd) {
  std::array<char, 128> bytes{};
  const ssize_t length = ::pread(fd, bytes.data(), bytes.size(), 0);
  if (length <= 0) return {};
  std::string_view text(bytes.data(), static_cast<std::size_t>(length));
  LockHolder holder;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), holder.pid);
  if (error != std::errc{}) return {};
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  const auto line_end = text.find('\n');
  if (line_end == std::string_view::npos) return {};  // half-written
  text = text.substr(0, line_end);
  if (text.starts_with(' ')) text.remove_prefix(1);
  holder.note = std::string(text);
  return holder;
}

bool same_file(int fd, const std::filesystem::path& path) {
  struct stat locked{};
  struct stat named{};
  return ::fstat(fd, &locked) == 0 && ::lstat(path.c_str(), &named) == 0 && locked.st_ino == named.st_ino &&
         locked.st_dev == named.st_dev;
}

}  // namespace

std::expected<LockFile, LockFile::Refused> LockFile::take(const std::filesystem::path& path, std::string_view note) {
  LockHolder holder;
  for (int i = 0; i < kTries; ++i) {
    Descriptor file(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0600));
    if (!file.valid()) return std::unexpected(failed(path, "open", errno));
    struct stat kind{};
    if (::fstat(file.get(), &kind) != 0 || !S_ISREG(kind.st_mode) || kind.st_uid != ::geteuid()) {
      return std::unexpected(failed(path, "use", EPERM));
    }
    if (::flock(file.get(), LOCK_EX | LOCK_NB) != 0) {
      if (errno != EWOULDBLOCK) return std::unexpected(failed(path, "take", errno));
      holder = read_holder(file.get());
      if (holder.pid != 0 && ::kill(holder.pid, 0) != 0 && errno == ESRCH) holder = {};  // of the holder before
      if (holder.pid != 0) break;
      std::this_thread::sleep_for(kBetweenTries);
      continue;
    }
    // Between open and flock the holder may have removed the file: the lock would be on an unlinked file.
    if (!same_file(file.get(), path)) continue;
    const std::string text = fmt::format("{} {}\n", ::getpid(), note);
    if (::ftruncate(file.get(), 0) != 0 ||
        ::pwrite(file.get(), text.data(), text.size(), 0) != static_cast<ssize_t>(text.size())) {
      return std::unexpected(failed(path, "write", errno));
    }
    return LockFile(std::move(file), path);
  }
  return std::unexpected(
      Refused{Refusal::held, holder,
              Error{holder.pid == 0 ? fmt::format("another process holds the lock {}", path.native())
                                    : fmt::format("process {} holds the lock {}", holder.pid, path.native()),
                    {}}});
}

LockFile& LockFile::operator=(LockFile&& other) noexcept {
  if (this != &other) {
    release();
    file_ = std::move(other.file_);
    path_ = std::move(other.path_);
  }
  return *this;
}

LockFile::~LockFile() { release(); }

void LockFile::release() {
  if (!file_.valid()) return;
  if (in_place()) ::unlink(path_.c_str());
  file_.reset();
}

bool LockFile::in_place() const { return file_.valid() && same_file(file_.get(), path_); }

std::optional<LockHolder> lock_holder(const std::filesystem::path& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  if (!file.valid()) return std::nullopt;
  // A shared lock: several processes may check at once; only the holder's exclusive lock conflicts.
  if (::flock(file.get(), LOCK_SH | LOCK_NB) == 0) return std::nullopt;
  return read_holder(file.get());
}

}  // namespace cellmirror
