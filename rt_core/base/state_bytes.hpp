// Plain state as bytes, in this machine's byte order: the same list of members writes it in the tick and reads it back
// elsewhere, so that the two cannot differ. The reader takes any bytes: every length, choice and reference is checked.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/real_time.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror {

// What a list of members is given. `Self` has bytes(pointer, size), fail() and kReads.
template <class Self>
class StateBytes {
 public:
  template <class... T>
  void operator()(T&... values) CELL_RT {
    (one(values), ...);
  }
  // An enumerator up to `last`.
  template <class Enum>
  void choice(Enum& value, Enum last) CELL_RT {
    auto number = std::to_underlying(value);
    one(number);
    if (number > std::to_underlying(last)) return self().fail();
    value = static_cast<Enum>(number);
  }
  // A number from 0 to `most`, as 16 bits.
  template <std::unsigned_integral N>
  void bounded(N& value, std::size_t most) CELL_RT {
    auto number = static_cast<std::uint16_t>(value);
    one(number);
    if (number > most) return self().fail();
    value = static_cast<N>(number);
  }
  // The first `count` of an array. Not for the tick where T allocates.
  template <class T, std::size_t N>
  void first(std::array<T, N>& values, std::size_t count) CELL_RT {
    for (std::size_t i = 0; i < count && i < N; ++i) one(values[i]);
  }

 private:
  Self& self() CELL_RT { return static_cast<Self&>(*this); }

  template <class T>
    requires std::is_arithmetic_v<T>
  void one(T& value) CELL_RT {
    if constexpr (std::is_same_v<T, bool>) {
      std::uint8_t byte = value ? 1 : 0;
      self().bytes(&byte, 1);
      value = byte != 0;
    } else {
      self().bytes(&value, sizeof(T));
    }
  }
  void one(Timestamp& value) CELL_RT { value.ns = time_ns(value.ns); }
  void one(Nanoseconds& value) CELL_RT { value = Nanoseconds(time_ns(value.count())); }
  // What is read can be subtracted.
  std::int64_t time_ns(std::int64_t value) CELL_RT {
    constexpr std::int64_t kMost = std::int64_t{1} << 62;
    std::int64_t ns = value;
    self().bytes(&ns, sizeof(ns));
    if (!Self::kReads || (ns > -kMost && ns < kMost)) return ns;
    self().fail();
    return value;
  }
  template <class T, std::size_t N>
  void one(std::array<T, N>& values) CELL_RT {
    for (T& value : values) one(value);
  }
  template <int Rows, int Columns, int Options>
    requires(Rows > 0 && Columns > 0)
  void one(Eigen::Matrix<double, Rows, Columns, Options>& value) CELL_RT {
    self().bytes(value.data(), sizeof(double) * Rows * Columns);
  }
  void one(Eigen::Quaterniond& value) CELL_RT { self().bytes(value.coeffs().data(), sizeof(double) * 4); }
  void one(Pose& value) CELL_RT { self().bytes(value.matrix().data(), sizeof(double) * 16); }
  // Of a type that lists its members, by itself, or beside it for plain data: transfer(archive, value).
  template <class T>
    requires std::is_class_v<T>
  void one(T& value) CELL_RT {
    if constexpr (requires { value.transfer(self()); }) {
      value.transfer(self());
    } else {
      transfer(self(), value);
    }
  }
};

// Into a buffer. What finds no room is left out, and ok() is false then.
class StateWriter : public StateBytes<StateWriter> {
 public:
  static constexpr bool kReads = false;

  explicit StateWriter(std::span<std::byte> buffer) : buffer_(buffer) {}

  void bytes(const void* data, std::size_t size) CELL_RT {
    if (size > buffer_.size() - size_) return fail();
    std::memcpy(buffer_.data() + size_, data, size);
    size_ += size;
  }
  // A reference to something that is written elsewhere: as its number (ObjectId); null: 0.
  template <class T>
  void reference(const T*& object) CELL_RT {
    const std::uint64_t id = object == nullptr ? 0 : object->reference_id();
    bytes(&id, sizeof(id));
  }
  // At most 255 bytes.
  void text(std::string_view text) CELL_RT {
    text = text.substr(0, 255);
    const auto size = static_cast<std::uint8_t>(text.size());
    bytes(&size, 1);
    bytes(text.data(), size);
  }
  void fail() CELL_RT { ok_ = false; }
  [[nodiscard]] bool ok() const CELL_RT { return ok_; }
  [[nodiscard]] std::size_t size() const CELL_RT { return size_; }
  [[nodiscard]] std::span<const std::byte> written() const CELL_RT { return buffer_.first(size_); }
  // Forgets what was written behind that many bytes.
  void rewind(std::size_t size) CELL_RT { size_ = size < size_ ? size : size_; }
  // Writes again what stands at an offset, e.g. a length that was not known yet.
  template <class T>
  void put_at(std::size_t offset, T value) CELL_RT {
    if (offset + sizeof(T) <= size_) std::memcpy(buffer_.data() + offset, &value, sizeof(T));
  }

 private:
  std::span<std::byte> buffer_;
  std::size_t size_ = 0;
  bool ok_ = true;
};

// From any bytes. After the first fault ok() is false, and values stay as they were. Not for the tick.
class StateReader : public StateBytes<StateReader> {
 public:
  static constexpr bool kReads = true;
  // The object that was written under that number; null: there is none.
  using Resolve = std::function<const void*(std::uint64_t id)>;

  explicit StateReader(std::span<const std::byte> data, Resolve resolve = {})
      : data_(data), resolve_(std::move(resolve)) {}

  void bytes(void* data, std::size_t size) noexcept {
    if (!ok_ || size > data_.size()) return fail();
    std::memcpy(data, data_.data(), size);
    data_ = data_.subspan(size);
  }
  template <class T>
  void reference(const T*& object) noexcept {
    std::uint64_t id = 0;
    bytes(&id, sizeof(id));
    object = nullptr;
    if (id == 0 || !ok_) return;
    object = static_cast<const T*>(resolve_ ? resolve_(id) : nullptr);
    if (object == nullptr) fail();
  }
  void text(std::string& out) {
    std::uint8_t size = 0;
    bytes(&size, 1);
    if (!ok_ || size > data_.size()) return fail();
    out.assign(reinterpret_cast<const char*>(data_.data()), size);
    data_ = data_.subspan(size);
  }
  void fail() noexcept { ok_ = false; }
  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] bool at_end() const { return data_.empty(); }
  [[nodiscard]] std::span<const std::byte> rest() const { return data_; }
  void skip(std::size_t size) noexcept {
    if (!ok_ || size > data_.size()) return fail();
    data_ = data_.subspan(size);
  }

 private:
  std::span<const std::byte> data_;
  Resolve resolve_;
  bool ok_ = true;
};

}  // namespace cellmirror
