// Encoding of the messages on a channel. A message lists its fields once, for writing and for reading.
//
//   struct Created {
//     std::uint32_t id = 0;
//     void fields(auto& bytes) { bytes(id); }
//   };
//
// Both processes come from one build and run on one machine, so numbers have its byte order. The reader accepts
// arbitrary bytes.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace cellmirror {

inline constexpr std::size_t kLongestText = 64UL << 10U;  // of a string in a message
inline constexpr std::size_t kMostElements = 4096;        // of a list in a message

class MessageWriter {
 public:
  explicit MessageWriter(std::vector<std::byte>& out) : out_(out) {}

  template <class... T>
  void operator()(T&... values) {
    (one(values), ...);
  }
  // An enumerator up to `last`.
  template <class Enum>
  void choice(Enum& value, Enum /*last*/) {
    one(static_cast<std::uint8_t>(value));
  }
  // `element` lists the fields of one.
  template <class T, class Element>
  void list(std::vector<T>& values, const Element& element) {
    one(static_cast<std::uint32_t>(values.size()));
    for (T& value : values) element(value);
  }

 private:
  void raw(const void* from, std::size_t size) {
    const auto* first = static_cast<const std::byte*>(from);
    out_.insert(out_.end(), first, first + size);
  }
  template <class T>
    requires std::is_arithmetic_v<T>
  void one(T value) {
    raw(&value, sizeof value);
  }
  template <std::size_t N, class T>
    requires std::is_trivially_copyable_v<T>
  void one(const std::array<T, N>& values) {
    raw(values.data(), sizeof(T) * N);
  }
  void one(const std::string& text) {
    one(static_cast<std::uint32_t>(text.size()));
    raw(text.data(), text.size());
  }

  std::vector<std::byte>& out_;
};

// Stops at the first field that is missing or too long; good() is false from then on.
class MessageReader {
 public:
  explicit MessageReader(std::span<const std::byte> bytes) : left_(bytes) {}

  template <class... T>
  void operator()(T&... values) {
    (one(values), ...);
  }
  template <class Enum>
  void choice(Enum& value, Enum last) {
    std::uint8_t number = 0;
    one(number);
    if (number > static_cast<std::uint8_t>(last)) good_ = false;
    if (good_) value = static_cast<Enum>(number);
  }
  template <class T, class Element>
  void list(std::vector<T>& values, const Element& element) {
    std::uint32_t count = 0;
    one(count);
    if (count > kMostElements) good_ = false;
    values.clear();
    for (std::uint32_t i = 0; good_ && i < count; ++i) element(values.emplace_back());
  }
  [[nodiscard]] bool good() const { return good_; }
  [[nodiscard]] std::span<const std::byte> left() const { return left_; }

 private:
  bool raw(void* to, std::size_t size) {
    if (size > left_.size()) good_ = false;
    if (!good_) return false;
    std::memcpy(to, left_.data(), size);
    left_ = left_.subspan(size);
    return true;
  }
  template <class T>
    requires std::is_arithmetic_v<T>
  void one(T& value) {
    if constexpr (std::same_as<T, bool>) {
      std::uint8_t byte = 0;
      one(byte);
      value = byte != 0;
    } else {
      raw(&value, sizeof value);
    }
  }
  template <std::size_t N, class T>
    requires std::is_arithmetic_v<T>
  void one(std::array<T, N>& values) {
    raw(values.data(), sizeof(T) * N);
  }
  void one(std::string& text) {
    std::uint32_t size = 0;
    one(size);
    if (size > kLongestText || size > left_.size()) good_ = false;
    if (!good_) return;
    text.assign(reinterpret_cast<const char*>(left_.data()), size);
    left_ = left_.subspan(size);
  }

  std::span<const std::byte> left_;
  bool good_ = true;
};

// Replaces the content of `out` by the index of the message in the variant and its fields.
template <class... Messages>
void encode_variant(std::variant<Messages...>& message, std::vector<std::byte>& out) {
  out.clear();
  MessageWriter bytes(out);
  auto kind = static_cast<std::uint8_t>(message.index());
  bytes(kind);
  std::visit([&bytes](auto& one) { one.fields(bytes); }, message);
}

// A decoded message. `rest`: the bytes behind its fields, for a message that declares kCarriesBytes.
template <class Variant>
struct ReceivedMessage {
  Variant message;
  std::span<const std::byte> rest;
};

// Returns false if the bytes are not one of these messages. `rest`: the bytes behind its fields.
template <class... Messages>
[[nodiscard]] bool decode_variant(std::span<const std::byte> from, std::variant<Messages...>& message,
                                  std::span<const std::byte>& rest) {
  MessageReader bytes(from);
  std::uint8_t kind = 0;
  bytes(kind);
  if (!bytes.good() || kind >= sizeof...(Messages)) return false;
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    static_cast<void>(((I == kind && (message.template emplace<I>(), true)) || ...));
  }(std::index_sequence_for<Messages...>{});
  std::visit([&bytes](auto& one) { one.fields(bytes); }, message);
  rest = bytes.left();
  return bytes.good();
}

// Returns nothing if the bytes are not one of the variant's messages, or if bytes follow a message that carries none.
template <class Variant>
[[nodiscard]] std::optional<ReceivedMessage<Variant>> decode_message(std::span<const std::byte> bytes) {
  ReceivedMessage<Variant> received;
  if (!decode_variant(bytes, received.message, received.rest)) return std::nullopt;
  const bool may_have_more =
      std::visit([]<class Message>(const Message&) { return requires { Message::kCarriesBytes; }; }, received.message);
  if (!received.rest.empty() && !may_have_more) return std::nullopt;
  return received;
}

}  // namespace cellmirror
