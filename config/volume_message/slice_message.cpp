#include "config/volume_message/slice_message.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

class SliceWriter {
 public:
  template <class T>
  void value(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    out_.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  void text(std::string_view text) {
    const std::string_view kept = text.substr(0, kLongestSliceText);
    value(static_cast<std::uint32_t>(kept.size()));
    out_ += kept;
  }
  template <class T>
  void maybe(const std::optional<T>& what) {
    value(static_cast<std::uint8_t>(what ? 1 : 0));
    if (what) value(*what);
  }
  std::string take() { return std::move(out_); }

 private:
  std::string out_;
};

// Reads from the front. After the first thing that is not there, nothing is.
class SliceParser {
 public:
  explicit SliceParser(std::string_view bytes) : left_(bytes) {}

  template <class T>
  void value(T& to) {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::string_view from = take(sizeof(T));
    if (!from.empty()) std::memcpy(&to, from.data(), sizeof(T));
  }
  void flag(bool& to) {
    std::uint8_t byte = 0;
    value(byte);
    if (byte > 1) good_ = false;
    to = byte == 1;
  }
  void text(std::string& to) {
    std::uint32_t size = 0;
    value(size);
    if (size > kLongestSliceText) good_ = false;
    to = take(size);
  }
  template <std::size_t kCount>
  void maybe(std::optional<std::array<double, kCount>>& to) {
    bool there = false;
    flag(there);
    if (!there || !good_) return;
    std::array<double, kCount> values{};
    value(values);
    constexpr double kFarthest = 1e6;
    if (!std::ranges::all_of(values, [](double one) { return std::abs(one) <= kFarthest; })) good_ = false;
    to = values;
  }
  [[nodiscard]] bool done() const { return good_ && left_.empty(); }

 private:
  std::string_view take(std::size_t size) {
    if (size > left_.size()) good_ = false;
    if (!good_) return {};
    const std::string_view out = left_.substr(0, size);
    left_.remove_prefix(size);
    return out;
  }

  std::string_view left_;
  bool good_ = true;
};

bool is_slice(const SliceHead& head) {
  constexpr double kLargestRescale = 1e9;
  constexpr std::uint32_t kMostBits = 64;
  return head.rows <= 0xFFFF && head.columns <= 0xFFFF && head.bits_allocated <= kMostBits &&
         head.bits_stored <= kMostBits && head.high_bit < kMostBits && std::abs(head.slope) <= kLargestRescale &&
         std::abs(head.intercept) <= kLargestRescale;
}

}  // namespace

std::string encode_slice_head(const SliceHead& head) {
  SliceWriter out;
  for (const std::string* text :
       {&head.patient, &head.series, &head.instance, &head.transfer_syntax, &head.modality, &head.manufacturer,
        &head.model, &head.description, &head.image_type, &head.photometric, &head.rescale_type})
    out.text(*text);
  for (const std::uint32_t number :
       {head.rows, head.columns, head.bits_allocated, head.bits_stored, head.high_bit, head.samples, head.frames})
    out.value(number);
  for (const bool flag : {head.is_signed, head.rescaled}) out.value(static_cast<std::uint8_t>(flag ? 1 : 0));
  out.value(head.slope);
  out.value(head.intercept);
  out.maybe(head.position);
  out.maybe(head.orientation);
  out.maybe(head.spacing);
  return out.take();
}

std::optional<SliceHead> decode_slice_head(std::string_view bytes) {
  if (bytes.size() > kLargestSliceHead) return std::nullopt;
  SliceParser from(bytes);
  SliceHead head;
  for (std::string* text :
       {&head.patient, &head.series, &head.instance, &head.transfer_syntax, &head.modality, &head.manufacturer,
        &head.model, &head.description, &head.image_type, &head.photometric, &head.rescale_type})
    from.text(*text);
  for (std::uint32_t* number : {&head.rows, &head.columns, &head.bits_allocated, &head.bits_stored, &head.high_bit,
                                &head.samples, &head.frames})
    from.value(*number);
  for (bool* flag : {&head.is_signed, &head.rescaled}) from.flag(*flag);
  from.value(head.slope);
  from.value(head.intercept);
  from.maybe(head.position);
  from.maybe(head.orientation);
  from.maybe(head.spacing);
  if (!from.done() || !is_slice(head)) return std::nullopt;
  return head;
}

std::string encode_slice_error(const Error& error) {
  SliceWriter out;
  out.text(error.what);
  out.text(error.remedy);
  return out.take();
}

std::optional<Error> decode_slice_error(std::string_view bytes) {
  constexpr std::size_t kPrinted = 300;
  SliceParser from(bytes);
  std::string what;
  std::string remedy;
  from.text(what);
  from.text(remedy);
  if (!from.done() || what.empty()) return std::nullopt;
  return Error{printable(what, kPrinted), printable(remedy, kPrinted)};
}

}  // namespace cellmirror
