// JSON written straight into a text, for documents that are made several times a second.
#pragma once

#include <Eigen/Core>
#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace cellmirror::app {

// Values follow each other in the order of the calls; commas are put where they belong. Every object and array that is
// begun has to be ended.
class JsonBuilder {
 public:
  JsonBuilder& begin_object() { return begin('{'); }
  JsonBuilder& begin_array() { return begin('['); }
  JsonBuilder& end_object() { return end('}'); }
  JsonBuilder& end_array() { return end(']'); }
  JsonBuilder& key(std::string_view name);

  // Nine significant digits; null for what is not finite, which JSON cannot hold.
  JsonBuilder& value(double number);
  JsonBuilder& fixed(double number, int decimals);
  JsonBuilder& value(const std::optional<double>& number) { return number ? value(*number) : null(); }
  template <std::integral Number>
  JsonBuilder& value(Number number) {
    return raw(std::to_string(number));
  }
  JsonBuilder& value(bool truth) { return raw(truth ? "true" : "false"); }
  // Any bytes; what is no UTF-8 is replaced.
  JsonBuilder& value(std::string_view text);
  JsonBuilder& value(const char* text) { return value(std::string_view(text)); }
  JsonBuilder& value(const Eigen::Vector3d& vector);
  JsonBuilder& null() { return raw("null"); }

  template <class Value>
  JsonBuilder& member(std::string_view name, const Value& of) {
    key(name);
    return value(of);
  }

  [[nodiscard]] std::string take() { return std::move(text_); }

 private:
  JsonBuilder& begin(char bracket);
  JsonBuilder& end(char bracket);
  JsonBuilder& raw(std::string_view text);
  void separate();

  std::string text_;
  bool first_ = true;  // of its object or array, or behind a key
};

}  // namespace cellmirror::app
