#include "config/volume/voxel_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include "config/volume/volume_data.hpp"

namespace cellmirror {

namespace {

struct NamedType {
  std::size_t bytes;
  const char* text;
};
constexpr std::array<NamedType, 10> kTypes{{{1, "8 bit signed"},
                                            {1, "8 bit unsigned"},
                                            {2, "16 bit signed"},
                                            {2, "16 bit unsigned"},
                                            {4, "32 bit signed"},
                                            {4, "32 bit unsigned"},
                                            {8, "64 bit signed"},
                                            {8, "64 bit unsigned"},
                                            {4, "32 bit floating point"},
                                            {8, "64 bit floating point"}}};

template <std::size_t kBytes>
using Bits = std::conditional_t<
    kBytes == 1, std::uint8_t,
    std::conditional_t<kBytes == 2, std::uint16_t, std::conditional_t<kBytes == 4, std::uint32_t, std::uint64_t>>>;

template <class T>
T turned(T value) {
  if constexpr (sizeof(T) == 1) {
    return value;
  } else {
    Bits<sizeof(T)> bits = std::bit_cast<Bits<sizeof(T)>>(value);
    if constexpr (sizeof(T) == 2) bits = __builtin_bswap16(bits);
    if constexpr (sizeof(T) == 4) bits = __builtin_bswap32(bits);
    if constexpr (sizeof(T) == 8) bits = __builtin_bswap64(bits);
    return std::bit_cast<T>(bits);
  }
}

// Slice after slice, in the order of the file.
class SliceReader {
 public:
  SliceReader(const VoxelSource& source, const VoxelFormat& format)
      : source_(source), format_(format), per_slice_(std::size_t{format.size[0]} * format.size[1]) {}

  [[nodiscard]] std::size_t per_slice() const { return per_slice_; }

  // Calls take(k, slice) for each; `into(k)` says where the values of slice k go meanwhile.
  template <class T, class Into, class Take>
  Result<void> each(const Into& into, const Take& take) {
    auto stream = open_voxels(source_, std::uint64_t{per_slice_} * format_.size[2] * sizeof(T));
    if (!stream) return std::unexpected(stream.error());
    for (std::uint32_t number = 0; number < format_.size[2]; ++number) {
      const std::uint32_t k = format_.last_slice_first ? format_.size[2] - 1 - number : number;
      const std::span<T> slice = into(k);
      if (auto read = (*stream)->read(std::as_writable_bytes(slice)); !read) return read;
      if (format_.big_endian) std::ranges::transform(slice, slice.begin(), [](T value) { return turned(value); });
      if (auto taken = take(k, slice); !taken) return taken;
    }
    return {};
  }

 private:
  const VoxelSource& source_;
  const VoxelFormat& format_;
  std::size_t per_slice_;
};

template <class T>
Result<VoxelValues> as_they_are(SliceReader& reader, std::size_t count) {
  std::vector<T> values(count);
  const std::size_t per_slice = reader.per_slice();
  const auto into = [&](std::uint32_t k) { return std::span(values).subspan(k * per_slice, per_slice); };
  const auto read = reader.each<T>(into, [](std::uint32_t, std::span<T>) { return Result<void>(); });
  if (!read) return std::unexpected(read.error());
  return VoxelValues{std::move(values)};
}

struct ValueRange {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
  bool whole = true;  // all values are integers
};

template <class T>
Result<ValueRange> range_of(SliceReader& reader, std::uint32_t columns) {
  std::vector<T> slice(reader.per_slice());
  ValueRange range;
  const auto take = [&](std::uint32_t k, std::span<T> values) -> Result<void> {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto value = static_cast<double>(values[i]);
      if (!std::isfinite(value))
        return fail(fmt::format("the voxel ({}, {}, {}) is {}", i % columns, i / columns, k, value),
                    "replace what is no number before exporting");
      range.least = std::min(range.least, value);
      range.most = std::max(range.most, value);
      if constexpr (std::is_floating_point_v<T>) range.whole = range.whole && value == std::trunc(value);
    }
    return {};
  };
  const auto read = reader.each<T>([&](std::uint32_t) { return std::span(slice); }, take);
  if (!read) return std::unexpected(read.error());
  return range;
}

// To = int16_t or uint16_t.
template <class T, class To>
Result<VoxelValues> in_steps(SliceReader& reader, std::size_t count, double slope, double intercept, bool rounded) {
  std::vector<To> values(count);
  std::vector<T> slice(reader.per_slice());
  constexpr auto kLeast = static_cast<double>(std::numeric_limits<To>::min());
  constexpr auto kMost = static_cast<double>(std::numeric_limits<To>::max());
  const auto take = [&](std::uint32_t k, std::span<T> from) {
    To* to = values.data() + k * from.size();
    for (std::size_t i = 0; i < from.size(); ++i) {
      // The file may have changed since its range was found.
      const double step = std::round((static_cast<double>(from[i]) - intercept) / slope);
      to[i] = static_cast<To>(step >= kLeast ? std::min(step, kMost) : kLeast);
    }
    return Result<void>();
  };
  const auto read = reader.each<T>([&](std::uint32_t) { return std::span(slice); }, take);
  if (!read) return std::unexpected(read.error());
  return VoxelValues{std::move(values), slope, intercept, rounded};
}

template <class T>
Result<VoxelValues> as_16_bits(SliceReader& reader, std::size_t count, std::uint32_t columns) {
  const auto range = range_of<T>(reader, columns);
  if (!range) return std::unexpected(range.error());
  constexpr double kSteps = 65535;
  const double width = range->most - range->least;
  if (!std::isfinite(width))
    return fail(fmt::format("the values reach from {:g} to {:g}", range->least, range->most), "scale them");
  constexpr double kMostExact = 9007199254740992.0;  // 2^53: doubles hold every integer up to it
  const bool exact = range->whole && range->least >= -kMostExact && range->most <= kMostExact;
  if (exact && width <= kSteps) {
    using S = std::numeric_limits<std::int16_t>;
    if (range->least >= S::min() && range->most <= S::max())
      return in_steps<T, std::int16_t>(reader, count, 1, 0, false);
    return in_steps<T, std::uint16_t>(reader, count, 1, range->least, false);
  }
  const double slope = width / kSteps;
  if (!(slope >= std::numeric_limits<double>::min()))
    return in_steps<T, std::uint16_t>(reader, count, 1, range->least, true);  // one value everywhere
  return in_steps<T, std::uint16_t>(reader, count, slope, range->least, true);
}

}  // namespace

std::size_t bytes_of(VoxelType type) { return kTypes[static_cast<std::size_t>(type)].bytes; }

std::string text_of(VoxelType type) { return kTypes[static_cast<std::size_t>(type)].text; }

Result<VoxelValues> read_voxels(const VoxelSource& source, const VoxelFormat& format) {
  const std::array<std::uint64_t, 3> size{format.size[0], format.size[1], format.size[2]};
  const bool byte = format.type == VoxelType::u8;
  if (auto fits = check_voxels(size, byte ? 1 : 2); !fits) return std::unexpected(fits.error());
  SliceReader reader(source, format);
  const std::size_t count = reader.per_slice() * format.size[2];
  const std::uint32_t columns = format.size[0];
  // Before memory is taken: whether the files can hold them.
  if (const auto probe = open_voxels(source, std::uint64_t{count} * bytes_of(format.type)); !probe)
    return std::unexpected(probe.error());
  switch (format.type) {
    case VoxelType::u8:
      return as_they_are<std::uint8_t>(reader, count);
    case VoxelType::s16:
      return as_they_are<std::int16_t>(reader, count);
    case VoxelType::u16:
      return as_they_are<std::uint16_t>(reader, count);
    case VoxelType::s8:
      return in_steps<std::int8_t, std::int16_t>(reader, count, 1, 0, false);
    case VoxelType::s32:
      return as_16_bits<std::int32_t>(reader, count, columns);
    case VoxelType::u32:
      return as_16_bits<std::uint32_t>(reader, count, columns);
    case VoxelType::s64:
      return as_16_bits<std::int64_t>(reader, count, columns);
    case VoxelType::u64:
      return as_16_bits<std::uint64_t>(reader, count, columns);
    case VoxelType::f32:
      return as_16_bits<float>(reader, count, columns);
    case VoxelType::f64:
      return as_16_bits<double>(reader, count, columns);
  }
  return fail("its type is unknown");
}

}  // namespace cellmirror
