#include "app/io/record_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "rt_core/base/descriptor.hpp"

namespace cellmirror::app {

namespace {

constexpr mode_t kRecordMode = 0600;
constexpr int kGzip = 15 + 16;  // deflateInit2(): the largest window, with the header of gzip
constexpr int kMemoryLevel = 8;
constexpr std::size_t kMostFiles = 65'536;  // of a folder that are looked at
constexpr const char* kPart = ".part";

Error write_error(const std::filesystem::path& file, int reason) {
  return {fmt::format("{} cannot be written: {}", file.string(), std::strerror(reason)),
          reason == ENOSPC || reason == EDQUOT ? "make room on the disk" : ""};
}

bool write_all(int file, const unsigned char* data, std::size_t bytes) {
  while (bytes > 0) {
    const ssize_t written = ::write(file, data, bytes);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    data += written;
    bytes -= static_cast<std::size_t>(written);
  }
  return true;
}

}  // namespace

struct RecordFile::State {
  std::filesystem::path file;
  std::filesystem::path part;
  Descriptor out;
  z_stream stream{};
  bool compressed = false;
  bool renamed = false;
  std::optional<Error> error;

  ~State() {
    if (compressed) ::deflateEnd(&stream);
    if (!renamed) ::unlink(part.c_str());
  }
  Result<void> failed(int reason) {
    error = write_error(part, reason);
    return std::unexpected(*error);
  }
  Result<void> put(const unsigned char* data, std::size_t bytes) {
    return write_all(out.get(), data, bytes) ? Result<void>() : failed(errno);
  }
  // `flush`: Z_NO_FLUSH, or Z_FINISH for the end.
  Result<void> deflate_all(std::string_view text, int flush) {
    std::array<unsigned char, std::size_t{1} << 16> room;
    stream.next_in = const_cast<unsigned char*>(reinterpret_cast<const unsigned char*>(text.data()));  // NOLINT: zlib
    stream.avail_in = static_cast<uInt>(text.size());
    do {
      stream.next_out = room.data();
      stream.avail_out = static_cast<uInt>(room.size());
      ::deflate(&stream, flush);
      if (auto put_out = put(room.data(), room.size() - stream.avail_out); !put_out) return put_out;
    } while (stream.avail_out == 0);
    return {};
  }
};

RecordFile::RecordFile(std::unique_ptr<State> state) : state_(std::move(state)) {}
RecordFile::RecordFile(RecordFile&&) noexcept = default;
RecordFile::~RecordFile() = default;

Result<RecordFile> RecordFile::create(const std::filesystem::path& file) {
  auto state = std::make_unique<State>();
  state->file = file;
  state->part = file;
  state->part += kPart;
  // A link there, a pipe or another user's file goes; what it points to is not touched.
  ::unlink(state->part.c_str());
  state->out =
      Descriptor(::open(state->part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, kRecordMode));
  if (!state->out.valid()) return std::unexpected(write_error(state->part, errno));
  if (file.extension() == ".gz") {
    if (::deflateInit2(&state->stream, Z_BEST_SPEED, Z_DEFLATED, kGzip, kMemoryLevel, Z_DEFAULT_STRATEGY) != Z_OK)
      return std::unexpected(write_error(state->part, ENOMEM));
    state->compressed = true;
  }
  return RecordFile(std::move(state));
}

Result<void> RecordFile::write(std::string_view text) {
  if (state_->error) return std::unexpected(*state_->error);
  if (state_->compressed) return state_->deflate_all(text, Z_NO_FLUSH);
  return state_->put(reinterpret_cast<const unsigned char*>(text.data()), text.size());
}

Result<void> RecordFile::finish() {
  if (state_->error) return std::unexpected(*state_->error);
  if (state_->compressed) {
    if (auto ended = state_->deflate_all({}, Z_FINISH); !ended) return ended;
  }
  // close() may report what write() did not: a full disk behind a network.
  if (::close(state_->out.release()) != 0) return state_->failed(errno);
  if (::rename(state_->part.c_str(), state_->file.c_str()) != 0) return state_->failed(errno);
  state_->renamed = true;
  return {};
}

std::size_t remove_old_records(const std::filesystem::path& folder, std::string_view prefix, std::size_t kept) {
  struct Found {
    std::uint64_t number;
    std::filesystem::path path;
  };
  std::vector<Found> records;
  std::vector<std::filesystem::path> doomed;
  std::error_code error;
  std::size_t looked_at = 0;
  for (std::filesystem::directory_iterator at(folder, error), end; !error && at != end && looked_at < kMostFiles;
       at.increment(error), ++looked_at) {
    const std::string name = at->path().filename().native();
    if (!name.starts_with(prefix) || !at->is_regular_file(error)) continue;
    std::uint64_t number = 0;
    const char* last = name.data() + name.size();
    if (std::from_chars(name.data() + prefix.size(), last, number).ec != std::errc()) continue;
    if (name.ends_with(kPart)) {
      doomed.push_back(at->path());
    } else {
      records.push_back({number, at->path()});
    }
  }
  std::ranges::sort(records, std::ranges::greater(), &Found::number);
  for (std::size_t i = kept; i < records.size(); ++i) doomed.push_back(records[i].path);
  std::size_t removed = 0;
  for (const auto& path : doomed) removed += std::filesystem::remove(path, error) ? 1U : 0U;
  return removed;
}

}  // namespace cellmirror::app
