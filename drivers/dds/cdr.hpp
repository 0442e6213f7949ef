// Reading and writing of classic CDR (XCDR version 1, OMG DDS-XTypes 1.3 section 7.4.1 and RTPS 2.3 section 10) as ROS
// 2 uses it: a 4-byte encapsulation header, then values aligned to their own size counted from behind that header.
// Pure: no I/O, no clock, no DDS library.
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

namespace cellmirror::dds {

// Why a payload was refused.
enum class CdrFault : std::uint8_t {
  none,
  encapsulation,  // neither CDR_BE (00 00) nor CDR_LE (00 01)
  truncated,      // a value or a length reaches beyond the end
  text,           // a string without its terminating zero
  too_many,       // more elements than this gateway accepts
  time,           // nanoseconds beyond a second, or a stamp before 1970
};
[[nodiscard]] std::string_view words(CdrFault fault);

namespace detail {
template <std::size_t Size>
struct Bits;
template <>
struct Bits<1> {
  using type = std::uint8_t;
};
template <>
struct Bits<2> {
  using type = std::uint16_t;
};
template <>
struct Bits<4> {
  using type = std::uint32_t;
};
template <>
struct Bits<8> {
  using type = std::uint64_t;
};

template <class T>
T load(const std::byte* from, bool swapped) {
  typename Bits<sizeof(T)>::type bits;
  std::memcpy(&bits, from, sizeof(T));
  if constexpr (sizeof(T) > 1) {
    if (swapped) {
      if constexpr (sizeof(T) == 8) bits = __builtin_bswap64(bits);
      if constexpr (sizeof(T) == 4) bits = __builtin_bswap32(bits);
      if constexpr (sizeof(T) == 2) bits = __builtin_bswap16(bits);
    }
  }
  return std::bit_cast<T>(bits);
}
}  // namespace detail

// A sequence of doubles inside a payload, which may lie unaligned and in foreign byte order. Valid as long as the
// payload.
class DoubleSequenceView {
 public:
  DoubleSequenceView() = default;
  DoubleSequenceView(const std::byte* first, std::size_t size, bool swapped)
      : first_(first), size_(size), swapped_(swapped) {}

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  // i < size().
  [[nodiscard]] double operator[](std::size_t i) const {
    return detail::load<double>(first_ + i * sizeof(double), swapped_);
  }

 private:
  const std::byte* first_ = nullptr;
  std::size_t size_ = 0;
  bool swapped_ = false;
};

// Reads values in order. The first fault sticks: from then on every read gives zero or nothing, so that a decoder may
// check once at its end. Never allocates.
class CdrReader {
 public:
  // `payload` begins with the encapsulation header and outlives the reader and all views that it gives.
  explicit CdrReader(std::span<const std::byte> payload);

  template <class T>
    requires(std::is_arithmetic_v<T>)
  T read() {
    const std::byte* at = take(sizeof(T), sizeof(T));
    return at == nullptr ? T{} : detail::load<T>(at, swapped_);
  }
  // Without the terminating zero. A length of zero, which some peers write for the empty string, is accepted.
  std::string_view read_text();
  DoubleSequenceView read_doubles();
  // A sequence of octets: what lies in the payload.
  std::span<const std::uint8_t> read_bytes();
  // So many octets; zeros where they are not there.
  void read_octets(std::span<std::uint8_t> out);
  // The number of elements that follow, each at least `least_bytes` long in any encoding; a number that cannot fit into
  // what is left of the payload, or beyond `most`, is a fault and gives zero.
  std::uint32_t read_count(std::size_t least_bytes, std::uint32_t most);

  // For values that a decoder finds wrong itself.
  void fail_with(CdrFault fault);
  [[nodiscard]] CdrFault fault() const { return fault_; }
  // What is left: padding, or members that a newer type appended.
  [[nodiscard]] std::size_t remaining() const { return body_.size() - position_; }

 private:
  const std::byte* take(std::size_t size, std::size_t alignment);

  std::span<const std::byte> body_;  // behind the encapsulation header: alignment counts from here
  std::size_t position_ = 0;
  bool swapped_ = false;
  CdrFault fault_ = CdrFault::none;
};

// Appends values, always little endian. `out` is emptied first and keeps its capacity, so that writing messages of the
// same shape again does not allocate.
class CdrWriter {
 public:
  explicit CdrWriter(std::vector<std::byte>& out);

  template <class T>
    requires(std::is_arithmetic_v<T>)
  void write(T value) {
    align(sizeof(T));
    auto bits = std::bit_cast<typename detail::Bits<sizeof(T)>::type>(value);
    if constexpr (std::endian::native == std::endian::big) bits = detail::load<decltype(bits)>(bytes_of(&bits), true);
    append(&bits, sizeof(T));
  }
  // Text with a zero inside is cut there: CDR's strings end with a zero.
  void write_text(std::string_view text);
  void write_count(std::size_t count) { write(static_cast<std::uint32_t>(count)); }
  void write_doubles(std::span<const double> values);
  void write_bytes(std::span<const std::uint8_t> values) { append(values.data(), values.size()); }
  // Appends zeros until there are so many bytes behind the encapsulation header.
  void fill_to(std::size_t bytes);

 private:
  static const std::byte* bytes_of(const void* value) { return static_cast<const std::byte*>(value); }
  void append(const void* from, std::size_t size) { out_.insert(out_.end(), bytes_of(from), bytes_of(from) + size); }
  void align(std::size_t alignment);

  std::vector<std::byte>& out_;
};

}  // namespace cellmirror::dds
