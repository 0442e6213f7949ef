#include "config/volume_reader/slice_pixels.hpp"

#include <fmt/format.h>
#include <gdcmByteValue.h>
#include <gdcmFile.h>
#include <gdcmImage.h>
#include <gdcmImageReader.h>
#include <gdcmPixelFormat.h>

#include <cstring>
#include <istream>

#include "config/volume_reader/memory_stream.hpp"

namespace cellmirror {

namespace {

// Bits above the high one belong to overlays of old; those below bits stored too.
template <class T>
void keep_stored_bits(std::vector<char>& bytes, std::uint32_t stored, std::uint32_t high, bool is_signed) {
  constexpr std::uint32_t kBits = 8 * sizeof(T);
  const std::uint32_t above = kBits - 1 - high;
  const std::uint32_t below = high + 1 - stored;
  if (above == 0 && below == 0) return;
  for (std::size_t at = 0; at + sizeof(T) <= bytes.size(); at += sizeof(T)) {
    T value{};
    std::memcpy(&value, bytes.data() + at, sizeof(T));
    value = static_cast<T>(value << above);
    if (is_signed) {
      value = static_cast<T>(static_cast<std::make_signed_t<T>>(value) >> (above + below));
    } else {
      value = static_cast<T>(value >> (above + below));
    }
    std::memcpy(bytes.data() + at, &value, sizeof(T));
  }
}

void widen_signed_bytes(std::vector<char>& bytes) {
  std::vector<char> wide(2 * bytes.size());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const int byte = static_cast<unsigned char>(bytes[i]);
    const auto value = static_cast<std::int16_t>(byte < 128 ? byte : byte - 256);
    std::memcpy(wide.data() + 2 * i, &value, sizeof(value));
  }
  bytes = std::move(wide);
}

Result<void> check_format(const gdcm::Image& image) {
  const gdcm::PixelFormat& format = image.GetPixelFormat();
  if (format.GetSamplesPerPixel() != 1)
    return fail(fmt::format("it has {} values a pixel", format.GetSamplesPerPixel()));
  const std::uint32_t allocated = format.GetBitsAllocated();
  if (allocated != 8 && allocated != 16) return fail(fmt::format("it has {} bits a pixel", allocated));
  if (format.GetBitsStored() < 1 || format.GetHighBit() >= allocated ||
      format.GetBitsStored() > format.GetHighBit() + 1U) {
    return fail(fmt::format("{} bits stored with the high bit {} do not fit {} bits", format.GetBitsStored(),
                            format.GetHighBit(), allocated));
  }
  if (image.GetNumberOfDimensions() > 2 && image.GetDimension(2) > 1)
    return fail(fmt::format("it has {} frames", image.GetDimension(2)), "export single-frame files");
  if (image.GetDimension(0) > kMostSliceSide || image.GetDimension(1) > kMostSliceSide)
    return fail(fmt::format("it has {} x {} pixels", image.GetDimension(0), image.GetDimension(1)));
  return {};
}

// GDCM takes zeros for what is missing.
bool is_short(const gdcm::File& file, const MemoryBuffer& buffer, const gdcm::Image& image) {
  // A deflated data set is read in pieces of any length.
  const bool deflated =
      file.GetHeader().GetDataSetTransferSyntax() == gdcm::TransferSyntax::DeflatedExplicitVRLittleEndian;
  if (buffer.cut() && !deflated) return true;
  const gdcm::Tag pixels(0x7fe0, 0x0010);
  if (!file.GetDataSet().FindDataElement(pixels)) return true;
  const gdcm::ByteValue* plain = file.GetDataSet().GetDataElement(pixels).GetByteValue();
  if (plain == nullptr) return false;  // in fragments: its decoder knows
  const std::size_t bits = image.GetPixelFormat().GetBitsAllocated();
  return plain->GetLength() < std::size_t{image.GetDimension(0)} * image.GetDimension(1) * bits / 8;
}

}  // namespace

Result<SlicePixels> read_slice_pixels(std::string_view bytes) {
  MemoryBuffer buffer(bytes);
  std::istream stream(&buffer);
  gdcm::ImageReader reader;
  reader.SetStream(stream);
  if (!reader.Read()) return fail("its image cannot be decoded");
  const gdcm::Image& image = reader.GetImage();
  if (auto fits = check_format(image); !fits) return std::unexpected(fits.error());
  const std::uint32_t allocated = image.GetPixelFormat().GetBitsAllocated();
  if (is_short(reader.GetFile(), buffer, image))
    return fail("its pixel data are shorter than its size says", "export it again");
  const std::size_t count = std::size_t{image.GetDimension(0)} * image.GetDimension(1);
  SlicePixels out;
  out.values.resize(image.GetBufferLength());
  if (out.values.size() != count * (allocated / 8) || !image.GetBuffer(out.values.data()))
    return fail("its pixel data are shorter than its size, or damaged");
  // Decoding may have changed the format.
  const gdcm::PixelFormat& format = image.GetPixelFormat();
  const bool is_signed = format.GetPixelRepresentation() == 1;
  out.head.columns = image.GetDimension(0);
  out.head.rows = image.GetDimension(1);
  if (allocated == 8) {
    keep_stored_bits<std::uint8_t>(out.values, format.GetBitsStored(), format.GetHighBit(), is_signed);
    if (is_signed) widen_signed_bytes(out.values);
    out.head.type = is_signed ? SliceValues::s16 : SliceValues::u8;
  } else {
    keep_stored_bits<std::uint16_t>(out.values, format.GetBitsStored(), format.GetHighBit(), is_signed);
    out.head.type = is_signed ? SliceValues::s16 : SliceValues::u16;
  }
  return out;
}

}  // namespace cellmirror
