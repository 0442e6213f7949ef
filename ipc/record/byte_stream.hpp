// Where the bytes of a recording go, and where they come from: files, and memory for tests. Not for the tick.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <utility>

#include "ipc/record/layout.hpp"
#include "rt_core/base/descriptor.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::mcap {

// One thread.
class Sink {
 public:
  Sink() = default;
  virtual ~Sink() = default;
  Sink(const Sink&) = delete;
  Sink& operator=(const Sink&) = delete;
  // The pieces one behind the other, all of them or none.
  virtual Result<void> write(std::span<const View> pieces) = 0;
};

// A new file, readable by its owner only (0600). What a failed write left behind is cut off, so that the file ends with
// a whole record.
class FileSink final : public Sink {
 public:
  // Fails where there is a file of that name already: a recording never replaces another.
  [[nodiscard]] static Result<std::unique_ptr<FileSink>> create(const std::filesystem::path& file);
  Result<void> write(std::span<const View> pieces) override;
  // Waits until the disk has it.
  Result<void> sync();
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  // Whether the name still leads to this file: a folder may have been removed.
  [[nodiscard]] bool still_there() const;

 private:
  FileSink(std::filesystem::path file, Descriptor descriptor)
      : file_(std::move(file)), descriptor_(std::move(descriptor)) {}

  std::filesystem::path file_;
  Descriptor descriptor_;
  std::uint64_t good_ = 0;  // bytes that are written as a whole
};

class MemorySink final : public Sink {
 public:
  Result<void> write(std::span<const View> pieces) override {
    for (const View piece : pieces) bytes.insert(bytes.end(), piece.begin(), piece.end());
    return {};
  }
  Bytes bytes;
};

// Any thread.
class Source {
 public:
  Source() = default;
  virtual ~Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;
  [[nodiscard]] virtual std::uint64_t size() const = 0;
  // All of `into`, from `offset` on; fails where the source ends before, or cannot be read.
  virtual Result<void> read(std::uint64_t offset, std::span<std::byte> into) const = 0;
};

// A regular file. Its size is that at the time of open(): one that is being written grows unseen.
class FileSource final : public Source {
 public:
  [[nodiscard]] static Result<std::unique_ptr<FileSource>> open(const std::filesystem::path& file);
  [[nodiscard]] std::uint64_t size() const override { return size_; }
  Result<void> read(std::uint64_t offset, std::span<std::byte> into) const override;

 private:
  FileSource(std::filesystem::path file, Descriptor descriptor, std::uint64_t size)
      : file_(std::move(file)), descriptor_(std::move(descriptor)), size_(size) {}

  std::filesystem::path file_;
  Descriptor descriptor_;
  std::uint64_t size_;
};

class MemorySource final : public Source {
 public:
  explicit MemorySource(View bytes) : bytes_(bytes) {}
  [[nodiscard]] std::uint64_t size() const override { return bytes_.size(); }
  Result<void> read(std::uint64_t offset, std::span<std::byte> into) const override;

 private:
  View bytes_;
};

}  // namespace cellmirror::mcap
