#include "ipc/record/compression.hpp"

#include <fmt/format.h>
#include <lz4frame.h>
#include <zstd.h>

#include <utility>

namespace cellmirror::mcap {

namespace {

constexpr int kZstdLevel = 1;

struct FreeZstdCompression {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
};
struct FreeZstdDecompression {
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};
struct FreeLz4Decompression {
  void operator()(LZ4F_dctx* context) const { LZ4F_freeDecompressionContext(context); }
};

std::unexpected<Error> not_compressed(const char* why) { return fail(fmt::format("compression failed: {}", why)); }

}  // namespace

std::optional<Compression> compression_of(std::string_view text) {
  if (text.empty() || text == "none") return Compression::none;
  if (text == "lz4") return Compression::lz4;
  if (text == "zstd") return Compression::zstd;
  return std::nullopt;
}

struct Compressor::Impl {
  Compression compression = Compression::none;
  Bytes out;
  std::unique_ptr<ZSTD_CCtx, FreeZstdCompression> zstd;
};

Compressor::Compressor(Compression compression) : impl_(std::make_unique<Impl>()) {
  impl_->compression = compression;
  if (compression == Compression::zstd) impl_->zstd.reset(ZSTD_createCCtx());
}

Compressor::~Compressor() = default;

Result<View> Compressor::compress(View data) {
  switch (impl_->compression) {
    case Compression::none:
      return data;
    case Compression::lz4: {
      LZ4F_preferences_t settings{};
      settings.frameInfo.blockSizeID = LZ4F_max1MB;
      settings.frameInfo.contentSize = data.size();
      impl_->out.resize(LZ4F_compressFrameBound(data.size(), &settings));
      const std::size_t size =
          LZ4F_compressFrame(impl_->out.data(), impl_->out.size(), data.data(), data.size(), &settings);
      if (LZ4F_isError(size) != 0) return not_compressed(LZ4F_getErrorName(size));
      return View(impl_->out).first(size);
    }
    case Compression::zstd: {
      if (!impl_->zstd) return not_compressed("no memory");
      impl_->out.resize(ZSTD_compressBound(data.size()));
      const std::size_t size = ZSTD_compressCCtx(impl_->zstd.get(), impl_->out.data(), impl_->out.size(), data.data(),
                                                 data.size(), kZstdLevel);
      if (ZSTD_isError(size) != 0) return not_compressed(ZSTD_getErrorName(size));
      return View(impl_->out).first(size);
    }
  }
  return data;
}

struct Decompressor::Impl {
  Bytes out;
  std::unique_ptr<ZSTD_DCtx, FreeZstdDecompression> zstd;
  std::unique_ptr<LZ4F_dctx, FreeLz4Decompression> lz4;

  Result<View> from_zstd(View data, std::size_t size) {
    if (!zstd) zstd.reset(ZSTD_createDCtx());
    if (!zstd) return fail("no memory to decompress");
    const std::size_t got = ZSTD_decompressDCtx(zstd.get(), out.data(), size, data.data(), data.size());
    if (ZSTD_isError(got) != 0) return fail(fmt::format("zstd: {}", ZSTD_getErrorName(got)));
    if (got != size) return fail(fmt::format("it decompresses to {} bytes, not to {} as it says", got, size));
    return View(out).first(size);
  }

  Result<View> from_lz4(View data, std::size_t size) {
    if (!lz4) {
      LZ4F_dctx* made = nullptr;
      if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION)) != 0)
        return fail("no memory to decompress");
      lz4.reset(made);
    }
    LZ4F_resetDecompressionContext(lz4.get());
    std::size_t written = 0;
    std::size_t hint = 1;
    // Ends: each round takes bytes of `data`, or gives bytes up to `size`, or is the last.
    while (hint != 0) {
      std::size_t given = size - written;
      std::size_t taken = data.size();
      hint = LZ4F_decompress(lz4.get(), out.data() + written, &given, data.data(), &taken, nullptr);
      if (LZ4F_isError(hint) != 0) return fail(fmt::format("lz4: {}", LZ4F_getErrorName(hint)));
      if (taken == 0 && given == 0) break;
      written += given;
      data = data.subspan(taken);
    }
    if (hint != 0 || !data.empty() || written != size)
      return fail(fmt::format("it does not decompress to the {} bytes that it says", size));
    return View(out).first(size);
  }
};

Decompressor::Decompressor() : impl_(std::make_unique<Impl>()) {}
Decompressor::~Decompressor() = default;

Result<View> Decompressor::decompress(std::string_view compression, View data, std::size_t size) {
  const std::optional<Compression> known = compression_of(compression);
  if (!known || compression == "none")
    return fail("the compression of the chunk is not known", "known: zstd, lz4, none");
  if (*known == Compression::none) {
    if (data.size() != size) return fail(fmt::format("it has {} bytes, not {} as it says", data.size(), size));
    return data;
  }
  // One byte more, so that the address of an empty result is one.
  if (impl_->out.size() < size + 1) impl_->out.resize(size + 1);
  return *known == Compression::zstd ? impl_->from_zstd(data, size) : impl_->from_lz4(data, size);
}

}  // namespace cellmirror::mcap
