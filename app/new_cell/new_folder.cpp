#include "app/new_cell/new_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <system_error>

namespace cellmirror::app {

namespace fs = std::filesystem;

namespace {

sigset_t ending_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals, number);
  return signals;
}

std::string reason(int error_number) { return std::error_code(error_number, std::generic_category()).message(); }

// Anything counts, also a link that leads nowhere.
bool is_taken(const fs::path& place) {
  std::error_code error;
  return fs::symlink_status(place, error).type() != fs::file_type::not_found;
}

std::unexpected<Error> taken(const fs::path& place) {
  return fail(fmt::format("there is a {} already", place.string()), "give the cell another name");
}

}  // namespace

// Blocked while it lives; one that waits ends the program when it is unblocked.
struct NewFolder::Signals {
  Signals() {
    const sigset_t signals = ending_signals();
    pthread_sigmask(SIG_BLOCK, &signals, &before);
  }
  ~Signals() { pthread_sigmask(SIG_SETMASK, &before, nullptr); }
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;
  [[nodiscard]] static bool waiting() {
    sigset_t pending;
    sigpending(&pending);
    return sigismember(&pending, SIGINT) == 1 || sigismember(&pending, SIGTERM) == 1 ||
           sigismember(&pending, SIGHUP) == 1;
  }
  sigset_t before{};
};

Result<std::unique_ptr<NewFolder>> NewFolder::make(const fs::path& place) {
  if (is_taken(place)) return taken(place);
  const fs::path above = place.has_parent_path() ? place.parent_path() : fs::path(".");
  std::error_code error;
  if (!fs::is_directory(above, error))
    return fail(fmt::format("there is no folder {}", above.string()), fmt::format("mkdir -p {}", above.string()));
  auto signals = std::make_unique<Signals>();
  std::string pattern = (above / ("." + place.filename().string() + ".new.XXXXXX")).string();
  if (::mkdtemp(pattern.data()) == nullptr)
    return fail(fmt::format("no folder can be made in {}: {}", above.string(), reason(errno)),
                "check its permissions and the room on the disk");
  return std::unique_ptr<NewFolder>(new NewFolder(place, pattern, std::move(signals)));
}

NewFolder::NewFolder(fs::path place, fs::path path, std::unique_ptr<Signals> signals)
    : place_(std::move(place)), path_(std::move(path)), signals_(std::move(signals)) {}

NewFolder::~NewFolder() {
  std::error_code error;
  if (!path_.empty()) fs::remove_all(path_, error);
}

Result<void> NewFolder::add(const PlannedFile& file) {
  const fs::path to = path_ / file.to;
  std::error_code error;
  fs::create_directories(to.parent_path(), error);
  if (!error && !file.from.empty()) {
    fs::copy_file(file.from, to, error);
    // The copy is the cell's own, whatever the mode of its source.
    if (!error) fs::permissions(to, fs::perms::owner_read | fs::perms::owner_write, fs::perm_options::add, error);
  }
  if (error)
    return fail(fmt::format("{} cannot be written: {}", file.to, error.message()), "check the room on the disk");
  if (!file.from.empty()) return {};
  std::ofstream out(to, std::ios::binary);
  out << file.text;
  out.close();
  if (!out) return fail(fmt::format("{} cannot be written: {}", file.to, reason(errno)), "check the room on the disk");
  return {};
}

Result<void> NewFolder::put_in_place() {
  if (Signals::waiting()) return fail("a signal has ended the program", "nothing was written");
  // mkdtemp() makes it for its owner alone; a cell's folder is like any other.
  const mode_t mask = ::umask(0);
  ::umask(mask);
  if (::chmod(path_.c_str(), 0777 & ~mask) != 0)
    return fail(fmt::format("{} cannot be written: {}", place_.string(), reason(errno)));
  if (::renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, place_.c_str(), RENAME_NOREPLACE) != 0) {
    if (errno == EEXIST) return taken(place_);
    // A file system that cannot refuse to replace; rename() itself replaces empty folders only.
    const bool unknown = errno == EINVAL || errno == ENOSYS;
    if (unknown && is_taken(place_)) return taken(place_);
    if (!unknown || ::rename(path_.c_str(), place_.c_str()) != 0)
      return fail(fmt::format("{} cannot be written: {}", place_.string(), reason(errno)));
  }
  path_.clear();
  return {};
}

}  // namespace cellmirror::app
