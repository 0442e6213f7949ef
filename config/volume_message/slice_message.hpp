// The protocol between the gateway and the reader of DICOM slices (config/volume_reader): a file a request, an answer
// each. Both programs are built together, so it has no version.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "rt_core/base/result.hpp"

namespace cellmirror {

inline constexpr std::size_t kLargestSliceFile = std::size_t{64} << 20U;  // bytes
inline constexpr std::uint32_t kMostSliceSide = 4096;                     // rows or columns

enum class SliceRequestKind : std::uint32_t {
  head = 1,         // the first bytes of a file
  head_of_all = 2,  // the same, with the whole file
  pixels = 3,       // the whole file
};

enum class SliceAnswerKind : std::uint32_t {
  head = 1,        // a SliceHead
  no_dicom = 2,    // the bytes are no DICOM file
  incomplete = 3,  // more of the file is needed
  pixels = 4,      // rows x columns values, 8 or 16 bits each, in this machine's byte order
  error = 5,       // why the file cannot be read
};

// Before each request and answer.
struct SliceFrame {
  std::uint32_t kind = 0;
  std::uint32_t reserved = 0;
  std::uint64_t bytes = 0;  // that follow
};

enum class SliceValues : std::uint32_t { u8 = 1, s16 = 2, u16 = 3 };

// Before the values of SliceAnswerKind::pixels.
struct SlicePixelsHead {
  std::uint32_t columns = 0;
  std::uint32_t rows = 0;
  SliceValues type = SliceValues::u8;
  std::uint32_t reserved = 0;
};

// Attributes of a slice (DICOM PS3.3). Lengths in mm as there. Texts may hold any bytes and are short.
struct SliceHead {
  std::string patient;          // identifies the patient; only compared, never shown
  std::string series;           // UID
  std::string instance;         // UID
  std::string transfer_syntax;  // UID
  std::string modality;
  std::string manufacturer;
  std::string model;
  std::string description;  // of the series
  std::string image_type;
  std::string photometric;
  std::string rescale_type;
  std::uint32_t rows = 0;  // 0: no image
  std::uint32_t columns = 0;
  std::uint32_t bits_allocated = 0;
  std::uint32_t bits_stored = 0;
  std::uint32_t high_bit = 0;
  std::uint32_t samples = 1;
  std::uint32_t frames = 1;
  bool is_signed = false;
  bool rescaled = false;  // slope and intercept are given
  double slope = 1;
  double intercept = 0;
  std::optional<std::array<double, 3>> position;     // ImagePositionPatient
  std::optional<std::array<double, 6>> orientation;  // ImageOrientationPatient: row, column
  std::optional<std::array<double, 2>> spacing;      // PixelSpacing: between rows, between columns
};

inline constexpr std::size_t kLargestSliceHead = std::size_t{16} << 10U;  // bytes of an answer
inline constexpr std::size_t kLargestSliceError = 2000;
inline constexpr std::size_t kLongestSliceText = 512;  // of a text of a SliceHead

[[nodiscard]] std::string encode_slice_head(const SliceHead& head);
// The input is untrusted: afterwards numbers are finite, sizes within their limits. None if the bytes are no head.
[[nodiscard]] std::optional<SliceHead> decode_slice_head(std::string_view bytes);

[[nodiscard]] std::string encode_slice_error(const Error& error);
// Printable.
[[nodiscard]] std::optional<Error> decode_slice_error(std::string_view bytes);

}  // namespace cellmirror
