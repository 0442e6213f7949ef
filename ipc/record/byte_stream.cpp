#include "ipc/record/byte_stream.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace cellmirror::mcap {

namespace {

constexpr mode_t kMode = 0600;
constexpr std::size_t kMostPieces = 16;

std::unexpected<Error> failed(const std::filesystem::path& file, const char* what, int reason) {
  const char* remedy = "see that the folder is there and that you may write it";
  if (reason == ENOSPC || reason == EDQUOT) remedy = "make room on the disk";
  if (reason == EEXIST) remedy = "give another name, or remove that file first";
  return fail(fmt::format("{} cannot be {}: {}", file.string(), what, std::strerror(reason)), remedy);
}

}  // namespace

Result<std::unique_ptr<FileSink>> FileSink::create(const std::filesystem::path& file) {
  Descriptor made(::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, kMode));
  if (!made.valid()) return failed(file, "created", errno);
  return std::unique_ptr<FileSink>(new FileSink(file, std::move(made)));
}

Result<void> FileSink::write(std::span<const View> pieces) {
  std::array<iovec, kMostPieces> waiting;
  std::size_t count = 0;
  for (const View piece : pieces) {
    if (piece.empty()) continue;
    if (count == kMostPieces) return fail("a record in too many pieces");
    waiting[count++] = {const_cast<std::byte*>(piece.data()), piece.size()};
  }
  std::uint64_t written = 0;
  for (std::size_t first = 0; first < count;) {
    const ssize_t got = ::writev(descriptor_.get(), &waiting[first], static_cast<int>(count - first));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) {
      const int reason = got < 0 ? errno : ENOSPC;
      [[maybe_unused]] const int cut = ::ftruncate(descriptor_.get(), static_cast<off_t>(good_));
      [[maybe_unused]] const off_t back = ::lseek(descriptor_.get(), static_cast<off_t>(good_), SEEK_SET);
      return failed(file_, "written", reason);
    }
    written += static_cast<std::uint64_t>(got);
    for (auto left = static_cast<std::size_t>(got); left > 0;) {
      const std::size_t part = std::min(left, waiting[first].iov_len);
      waiting[first].iov_base = static_cast<std::byte*>(waiting[first].iov_base) + part;
      waiting[first].iov_len -= part;
      left -= part;
      if (waiting[first].iov_len == 0) ++first;
    }
  }
  good_ += written;
  return {};
}

Result<void> FileSink::sync() {
  if (::fdatasync(descriptor_.get()) != 0) return failed(file_, "written", errno);
  return {};
}

bool FileSink::still_there() const {
  struct stat named{};
  struct stat opened{};
  return ::stat(file_.c_str(), &named) == 0 && ::fstat(descriptor_.get(), &opened) == 0 &&
         named.st_ino == opened.st_ino && named.st_dev == opened.st_dev;
}

Result<std::unique_ptr<FileSource>> FileSource::open(const std::filesystem::path& file) {
  Descriptor opened(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat info{};
  if (!opened.valid() || ::fstat(opened.get(), &info) != 0)
    return fail(fmt::format("{} cannot be read: {}", file.string(), std::strerror(errno)));
  if (!S_ISREG(info.st_mode)) return fail(fmt::format("{} is no file", file.string()), "name an .mcap file");
  return std::unique_ptr<FileSource>(new FileSource(file, std::move(opened), static_cast<std::uint64_t>(info.st_size)));
}

Result<void> FileSource::read(std::uint64_t offset, std::span<std::byte> into) const {
  while (!into.empty()) {
    const ssize_t got = ::pread(descriptor_.get(), into.data(), into.size(), static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) {
      return fail(fmt::format("{} cannot be read at byte {}: {}", file_.string(), offset,
                              got < 0 ? std::strerror(errno) : "it ends there"));
    }
    offset += static_cast<std::uint64_t>(got);
    into = into.subspan(static_cast<std::size_t>(got));
  }
  return {};
}

Result<void> MemorySource::read(std::uint64_t offset, std::span<std::byte> into) const {
  if (offset > bytes_.size() || into.size() > bytes_.size() - offset) return fail("the bytes end before");
  std::ranges::copy(bytes_.subspan(static_cast<std::size_t>(offset), into.size()), into.begin());
  return {};
}

}  // namespace cellmirror::mcap
