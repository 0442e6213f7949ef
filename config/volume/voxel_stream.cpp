#include "config/volume/voxel_stream.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace fs = std::filesystem;

namespace {

std::string name_of(const fs::path& path) { return printable(path.filename().string()); }

// How many bytes came, fewer only at the end of the file.
Result<std::size_t> read_at(const OpenedFile& file, const fs::path& path, std::uint64_t offset,
                            std::span<std::byte> to) {
  std::size_t done = 0;
  while (done < to.size()) {
    const ssize_t count =
        pread(file.descriptor.get(), to.data() + done, to.size() - done, static_cast<off_t>(offset + done));
    if (count == 0) break;
    if (count > 0) done += static_cast<std::size_t>(count);
    if (count < 0 && errno != EINTR) return fail(fmt::format("{}: {}", name_of(path), std::strerror(errno)));
  }
  return done;
}

class RawStream final : public VoxelStream {
 public:
  RawStream(VoxelSource source, std::uint64_t bytes_per_file)
      : source_(std::move(source)), bytes_per_file_(bytes_per_file) {}

  Result<void> read(std::span<std::byte> to) override {
    while (!to.empty()) {
      if (file_ >= source_.files.size()) return fail("there are fewer bytes than voxels");
      const fs::path& path = source_.files[file_];
      if (!opened_.descriptor.valid()) {
        auto opened = open_regular_file(path);
        if (!opened) return std::unexpected(opened.error());
        opened_ = std::move(*opened);
        start_ = source_.at_end ? opened_.bytes - std::min(opened_.bytes, bytes_per_file_) : source_.skip_bytes;
      }
      const auto part = static_cast<std::size_t>(std::min<std::uint64_t>(to.size(), bytes_per_file_ - at_));
      const auto count = read_at(opened_, path, start_ + at_, to.first(part));
      if (!count) return std::unexpected(count.error());
      if (*count < part)
        return fail(fmt::format("{} ends after {} of {} bytes", name_of(path), at_ + *count, bytes_per_file_));
      to = to.subspan(part);
      at_ += part;
      if (at_ < bytes_per_file_) continue;
      opened_ = {};
      at_ = 0;
      ++file_;
    }
    return {};
  }

 private:
  VoxelSource source_;
  std::uint64_t bytes_per_file_;
  std::size_t file_ = 0;
  OpenedFile opened_;
  std::uint64_t start_ = 0;
  std::uint64_t at_ = 0;  // in the data of the file
};

class GzipStream final : public VoxelStream {
 public:
  GzipStream(fs::path path, OpenedFile file, std::uint64_t offset)
      : path_(std::move(path)), file_(std::move(file)), offset_(offset) {
    constexpr int kGzipOrZlib = 32;
    good_ = inflateInit2(&state_, MAX_WBITS + kGzipOrZlib) == Z_OK;
  }
  ~GzipStream() override { inflateEnd(&state_); }
  GzipStream(const GzipStream&) = delete;
  GzipStream& operator=(const GzipStream&) = delete;

  Result<void> read(std::span<std::byte> to) override {
    if (!good_) return fail("there is no memory to inflate the data");
    while (!to.empty()) {
      if (state_.avail_in == 0) {
        const auto count = read_at(file_, path_, offset_, std::as_writable_bytes(std::span(input_)));
        if (!count) return std::unexpected(count.error());
        if (*count == 0) return fail(fmt::format("{} ends before its data are complete", name_of(path_)));
        offset_ += *count;
        state_.next_in = input_.data();
        state_.avail_in = static_cast<uInt>(*count);
      }
      constexpr std::size_t kAtOnce = std::size_t{1} << 30U;
      const std::size_t wanted = std::min(to.size(), kAtOnce);
      state_.next_out = reinterpret_cast<Bytef*>(to.data());
      state_.avail_out = static_cast<uInt>(wanted);
      const int result = inflate(&state_, Z_NO_FLUSH);
      to = to.subspan(wanted - state_.avail_out);
      if (result == Z_STREAM_END && !to.empty()) {
        if (inflateReset(&state_) != Z_OK) return damaged();  // another member follows
      } else if (result != Z_OK && result != Z_STREAM_END && result != Z_BUF_ERROR) {
        return damaged();
      }
    }
    return {};
  }

 private:
  [[nodiscard]] std::unexpected<Error> damaged() const {
    const char* why = state_.msg != nullptr ? state_.msg : "not gzip";
    return fail(fmt::format("the compressed data of {} are damaged: {}", name_of(path_), why), "export it again");
  }

  fs::path path_;
  OpenedFile file_;
  std::uint64_t offset_;
  z_stream state_{};
  bool good_ = false;
  std::array<Bytef, std::size_t{64} << 10U> input_{};
};

Result<std::unique_ptr<VoxelStream>> open_gzip(const VoxelSource& source, std::uint64_t bytes) {
  const fs::path& path = source.files.front();
  auto file = open_regular_file(path);
  if (!file) return std::unexpected(file.error());
  const std::uint64_t held = file->bytes - std::min(file->bytes, source.skip_bytes);
  constexpr std::uint64_t kMostExpansion = 1032;  // of DEFLATE
  if (bytes / kMostExpansion > held) {
    return fail(fmt::format("the {} compressed bytes of {} cannot hold {} bytes", held, name_of(path), bytes),
                "correct the size");
  }
  return std::make_unique<GzipStream>(path, std::move(*file), source.skip_bytes);
}

}  // namespace

Result<OpenedFile> open_regular_file(const fs::path& path) {
  OpenedFile out;
  out.descriptor = Descriptor(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat status{};
  if (!out.descriptor.valid() || fstat(out.descriptor.get(), &status) != 0)
    return fail(fmt::format("{} cannot be opened: {}", printable(path.string()), std::strerror(errno)));
  if (!S_ISREG(status.st_mode)) return fail(fmt::format("{} is no regular file", printable(path.string())));
  out.bytes = static_cast<std::uint64_t>(status.st_size);
  return out;
}

Result<std::string> read_part_of_file(const fs::path& path, std::uint64_t offset, std::size_t count) {
  const auto file = open_regular_file(path);
  if (!file) return std::unexpected(file.error());
  const std::uint64_t left = file->bytes - std::min(file->bytes, offset);
  std::string out(static_cast<std::size_t>(std::min<std::uint64_t>(count, left)), '\0');
  const auto done = read_at(*file, path, offset, std::as_writable_bytes(std::span(out)));
  if (!done) return std::unexpected(done.error());
  out.resize(*done);
  return out;
}

Result<std::unique_ptr<VoxelStream>> open_voxels(const VoxelSource& source, std::uint64_t bytes) {
  if (source.files.empty()) return fail("no file holds the voxels");
  if (source.gzip) return open_gzip(source, bytes);
  if (bytes % source.files.size() != 0)
    return fail(fmt::format("{} files cannot hold {} bytes in equal parts", source.files.size(), bytes));
  const std::uint64_t each = bytes / source.files.size();
  for (const fs::path& path : source.files) {
    const auto file = open_regular_file(path);
    if (!file) return std::unexpected(file.error());
    const std::uint64_t skipped = source.at_end ? 0 : source.skip_bytes;
    if (file->bytes < skipped || file->bytes - skipped < each) {
      return fail(fmt::format("{} has {} bytes, {} are needed", name_of(path), file->bytes, skipped + each),
                  "correct the size, the type or the header's length");
    }
  }
  return std::make_unique<RawStream>(source, each);
}

}  // namespace cellmirror
