// The compressions of MCAP's chunks. One thread an object; keeps its buffers. Not for the tick.
#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "ipc/record/layout.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::mcap {

[[nodiscard]] std::optional<Compression> compression_of(std::string_view word);

class Compressor {
 public:
  // Fast levels: zstd 1, LZ4's default.
  explicit Compressor(Compression compression);
  ~Compressor();
  Compressor(const Compressor&) = delete;
  Compressor& operator=(const Compressor&) = delete;

  // The result is valid until the next call; `data` itself where nothing is compressed.
  [[nodiscard]] Result<View> compress(View data);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

class Decompressor {
 public:
  Decompressor();
  ~Decompressor();
  Decompressor(const Decompressor&) = delete;
  Decompressor& operator=(const Decompressor&) = delete;

  // Exactly `size` bytes, which the caller has checked against its bound; anything else in `data` is an error, and
  // never more than `size` bytes are written. The result is valid until the next call, or `data` itself.
  [[nodiscard]] Result<View> decompress(std::string_view compression, View data, std::size_t size);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace cellmirror::mcap
