// JSON written straight into a text: for documents that are made several times a second and for lines of a long list.
// A document that is built once and looked into before it is written is better off with nlohmann::json.
#pragma once

#include <Eigen/Core>
#include <concepts>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace cellmirror {

// Values follow each other in the order of the calls; commas are put where they belong. Every object and array that is
// begun has to be ended.
class JsonWriter {
 public:
  static constexpr int kExact = 0;  // the shortest digits that give the same double again
  // `digits`: how many significant ones numbers get.
  explicit JsonWriter(int digits = 9) : digits_(digits) {}

  JsonWriter& begin_object() { return begin('{'); }
  JsonWriter& begin_array() { return begin('['); }
  JsonWriter& end_object() { return end('}'); }
  JsonWriter& end_array() { return end(']'); }
  JsonWriter& key(std::string_view name);

  // null for what is not finite, which JSON cannot hold.
  JsonWriter& value(double number);
  JsonWriter& fixed(double number, int decimals);
  JsonWriter& value(const std::optional<double>& number) { return number ? value(*number) : null(); }
  template <std::integral Number>
  JsonWriter& value(Number number) {
    return raw(std::to_string(number));
  }
  JsonWriter& value(bool truth) { return raw(truth ? "true" : "false"); }
  // Any bytes; each one that is no UTF-8 is replaced by U+FFFD.
  JsonWriter& value(std::string_view text);
  JsonWriter& value(const char* text) { return value(std::string_view(text)); }
  JsonWriter& value(const Eigen::Vector3d& vector);
  JsonWriter& value(std::span<const std::string> texts);
  JsonWriter& null() { return raw("null"); }

  template <class Value>
  JsonWriter& member(std::string_view name, const Value& of) {
    key(name);
    return value(of);
  }
  JsonWriter& fixed_member(std::string_view name, double number, int decimals) {
    key(name);
    return fixed(number, decimals);
  }

  // What comes next, be it a value or the end of its array, begins a line.
  JsonWriter& line();

  // What has been written since the last call: a long document can be given away piece by piece.
  [[nodiscard]] std::string take() { return std::exchange(text_, {}); }

 private:
  JsonWriter& begin(char bracket);
  JsonWriter& end(char bracket);
  JsonWriter& raw(std::string_view text);
  void separate();
  void break_line();

  std::string text_;
  int digits_;
  bool first_ = true;  // of its object or array, or behind a key
  bool line_ = false;
};

}  // namespace cellmirror
