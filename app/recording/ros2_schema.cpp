#include "app/recording/ros2_schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace {

constexpr int kDeepest = 16;
constexpr std::size_t kMostTypes = 512;
constexpr std::size_t kMostSteps = 4 * kMostValues;  // structures may be empty, so that bytes do not bound them
constexpr std::size_t kMostFields = 4096;            // of all definitions of a schema
constexpr std::size_t kLongestSchema = std::size_t{1} << 20;
constexpr std::uint32_t kMostBytesAsValues = 64;  // longer sequences of bytes are pictures and the like

struct Primitive {
  std::string_view name;
  std::size_t bytes;  // 0: a text
};
constexpr std::array<Primitive, 14> kPrimitives = {{{"bool", 1},
                                                    {"byte", 1},
                                                    {"char", 1},
                                                    {"int8", 1},
                                                    {"uint8", 1},
                                                    {"int16", 2},
                                                    {"uint16", 2},
                                                    {"int32", 4},
                                                    {"uint32", 4},
                                                    {"float32", 4},
                                                    {"int64", 8},
                                                    {"uint64", 8},
                                                    {"float64", 8},
                                                    {"string", 0}}};

const Primitive* primitive(std::string_view name) {
  for (const Primitive& one : kPrimitives)
    if (one.name == name) return &one;
  return nullptr;
}

// "pkg/msg/Type" as "pkg/Type".
std::string short_type(std::string_view name) {
  const std::size_t first = name.find('/');
  const std::size_t last = name.rfind('/');
  if (first == std::string_view::npos || first == last) return std::string(name);
  return fmt::format("{}/{}", name.substr(0, first), name.substr(last + 1));
}

std::string_view package_of(std::string_view type) { return type.substr(0, type.find('/')); }

bool is_divider(std::string_view line) {
  return line.size() >= 3 && line.find_first_not_of('=') == std::string_view::npos;
}

// The next line, without its end; moves on in `text`.
std::string_view next_line(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(text.size(), line.size() + 1));
  return trimmed(line);
}

std::string_view next_word(std::string_view& line) {
  line = trimmed(line);
  const std::string_view word = line.substr(0, line.find_first_of(" \t"));
  line.remove_prefix(word.size());
  return word;
}

template <class T>
T load(const std::byte* from, bool swapped) {
  std::array<std::byte, sizeof(T)> bytes;
  for (std::size_t i = 0; i < sizeof(T); ++i) bytes[swapped ? sizeof(T) - 1 - i : i] = from[i];
  return std::bit_cast<T>(bytes);
}

}  // namespace

Result<Ros2Schema::Field> Ros2Schema::parse_field(std::string_view package, std::string_view type,
                                                  std::string_view name) {
  Field field;
  field.name = name;
  if (const std::size_t bracket = type.find('['); bracket != std::string_view::npos) {
    std::string_view size = type.substr(bracket + 1);
    if (!size.ends_with(']')) return fail(fmt::format("the type {} has no ]", printable(type)));
    size.remove_suffix(1);
    type = type.substr(0, bracket);
    field.count = Count::sequence;
    if (!size.empty() && !size.starts_with("<=")) {
      const auto number = parse_integer(size);
      if (!number || *number < 0 || *number > static_cast<long long>(kMostValues))
        return fail(fmt::format("{} is no size of an array", printable(size)));
      field.count = Count::fixed;
      field.size = static_cast<std::uint32_t>(*number);
    }
  }
  if (type.starts_with("string<=")) type = "string";
  if (type == "wstring" || type.starts_with("wstring<=")) return fail("texts of wide characters are not supported");
  if (type == "time" || type == "duration") type = "builtin_interfaces/Time";
  if (type == "Header") type = "std_msgs/Header";
  if (primitive(type) != nullptr || type.find('/') != std::string_view::npos) {
    field.type = primitive(type) != nullptr ? std::string(type) : short_type(type);
  } else {
    field.type = fmt::format("{}/{}", package, type);
  }
  return field;
}

Result<Ros2Schema::Definition> Ros2Schema::parse_definition(std::string_view package, std::string_view text) {
  Definition out;
  while (!text.empty()) {
    std::string_view line = next_line(text);
    if (const std::size_t comment = line.find('#'); comment != std::string_view::npos) {
      // A # within a default text would be cut off too; the default is not used.
      line = line.substr(0, comment);
    }
    const std::string_view type = next_word(line);
    if (type.empty()) continue;
    const std::string_view name = next_word(line);
    // A constant: NAME=value or NAME = value.
    if (name.find('=') != std::string_view::npos || trimmed(line).starts_with('=')) continue;
    if (name.empty()) return fail(fmt::format("the line {} has no name", printable(type)));
    auto field = parse_field(package, type, name);
    if (!field) return std::unexpected(field.error());
    out.push_back(*std::move(field));
    if (out.size() > kMostFields) return fail("a schema of too many fields");
  }
  return out;
}

Result<Ros2Schema> Ros2Schema::parse(std::string_view name, std::string_view text) {
  if (text.size() > kLongestSchema) return fail(fmt::format("the schema {} is too long", printable(name)));
  Ros2Schema out;
  out.root_ = short_type(name);
  out.definitions_["builtin_interfaces/Time"] = {{"sec", "int32"}, {"nanosec", "uint32"}};
  std::string type = out.root_;
  std::size_t fields = 0;
  while (true) {
    const std::string_view before = text;
    std::string_view end = text;
    while (!text.empty()) {
      end = text;
      if (is_divider(next_line(text))) break;
      end = text;
    }
    const std::string_view part = before.substr(0, before.size() - end.size());
    auto definition = parse_definition(package_of(type), part);
    if (!definition) return fail(fmt::format("the schema {}: {}", printable(name), definition.error().what));
    fields += definition->size();
    if (fields > kMostFields) return fail(fmt::format("the schema {} has too many fields", printable(name)));
    out.definitions_.insert_or_assign(type, *std::move(definition));
    if (end.empty()) break;
    const std::string_view heading = next_line(text);
    if (!heading.starts_with("MSG:"))
      return fail(fmt::format("the schema {} has no MSG: behind a line of =", printable(name)));
    type = short_type(trimmed(heading.substr(4)));
  }
  std::map<std::string, int, std::less<>> heights;
  if (const auto checked = out.height(out.root_, heights); !checked)
    return fail(fmt::format("the schema {}: {}", printable(name), checked.error().what));
  return out;
}

// `heights`: of the types that were looked at; kOpen while one is.
Result<int> Ros2Schema::height(const std::string& type, std::map<std::string, int, std::less<>>& heights) const {
  constexpr int kOpen = -1;
  const auto [entry, is_new] = heights.try_emplace(type, kOpen);
  if (!is_new && entry->second == kOpen) return fail(fmt::format("{} contains itself", printable(type)));
  if (!is_new) return entry->second;
  const auto found = definitions_.find(type);
  if (found == definitions_.end()) return fail(fmt::format("the type {} is not described", printable(type)));
  int highest = 0;
  for (const Field& field : found->second) {
    if (primitive(field.type) != nullptr) continue;
    // The recursion is as deep as there are types, which are bounded by the text's length.
    if (heights.size() > kMostTypes) return fail("it has too many types");
    const auto below = height(field.type, heights);
    if (!below) return below;
    highest = std::max(highest, *below + 1);
  }
  if (highest > kDeepest) return fail(fmt::format("{} is too deep", printable(type)));
  heights[type] = highest;
  return highest;
}

// Walks a definition and a message side by side.
class Ros2Schema::Values {
 public:
  Values(const Ros2Schema& schema, std::span<const std::byte> body, bool swapped, std::size_t most_alignment)
      : schema_(schema), body_(body), swapped_(swapped), most_alignment_(most_alignment) {}

  bool read(const std::string& type, const std::string& prefix) {
    const Definition& definition = schema_.definitions_.find(type)->second;
    if (definition.empty()) return take(1, 1) != nullptr;  // CDR has no structure without members
    for (const Field& field : definition) {
      if (!read_field(field, prefix.empty() ? field.name : prefix + "." + field.name)) return false;
    }
    return true;
  }
  FlatMessage take_values() { return std::move(out_); }
  [[nodiscard]] std::size_t position() const { return position_; }

 private:
  bool read_field(const Field& field, const std::string& path) {
    if (++steps_ > kMostSteps) return false;
    if (field.count == Count::one) return read_element(field, path);
    std::uint32_t size = field.size;
    if (field.count == Count::sequence) {
      const std::byte* at = take(4, 4);
      if (at == nullptr) return false;
      size = load<std::uint32_t>(at, swapped_);
    }
    // Every element takes a byte at least.
    if (size > body_.size() - position_) return false;
    const Primitive* kind = primitive(field.type);
    if (kind != nullptr && kind->bytes == 1 && size > kMostBytesAsValues) {
      position_ += size;
      return add(path, fmt::format("{} bytes", size), true);
    }
    for (std::uint32_t i = 0; i < size; ++i)
      if (!read_element(field, fmt::format("{}[{}]", path, i))) return false;
    return true;
  }

  bool read_element(const Field& field, const std::string& path) {
    const Primitive* kind = primitive(field.type);
    if (kind == nullptr) return read(field.type, path);
    if (kind->bytes == 0) return read_text(path);
    const std::byte* at = take(kind->bytes, kind->bytes);
    return at != nullptr && add(path, number(field.type, at), false);
  }

  bool read_text(const std::string& path) {
    const std::byte* at = take(4, 4);
    if (at == nullptr) return false;
    const auto size = load<std::uint32_t>(at, swapped_);
    if (size > body_.size() - position_) return false;
    std::string text(reinterpret_cast<const char*>(body_.data() + position_), size);
    position_ += size;
    if (!text.empty() && text.back() == '\0') text.pop_back();
    return add(path, std::move(text), true);
  }

  [[nodiscard]] std::string number(std::string_view type, const std::byte* at) const {
    if (type == "bool") return load<std::uint8_t>(at, false) != 0 ? "true" : "false";
    if (type == "int8") return fmt::format("{}", static_cast<int>(load<std::int8_t>(at, false)));
    if (type == "int16") return fmt::format("{}", load<std::int16_t>(at, swapped_));
    if (type == "uint16") return fmt::format("{}", load<std::uint16_t>(at, swapped_));
    if (type == "int32") return fmt::format("{}", load<std::int32_t>(at, swapped_));
    if (type == "uint32") return fmt::format("{}", load<std::uint32_t>(at, swapped_));
    if (type == "int64") return fmt::format("{}", load<std::int64_t>(at, swapped_));
    if (type == "uint64") return fmt::format("{}", load<std::uint64_t>(at, swapped_));
    if (type == "float32") return fmt::format("{}", load<float>(at, swapped_));
    if (type == "float64") return fmt::format("{}", load<double>(at, swapped_));
    return fmt::format("{}", static_cast<unsigned>(load<std::uint8_t>(at, false)));
  }

  const std::byte* take(std::size_t size, std::size_t alignment) {
    alignment = std::min(alignment, most_alignment_);
    const std::size_t begin = (position_ + alignment - 1) / alignment * alignment;
    if (begin > body_.size() || size > body_.size() - begin) return nullptr;
    position_ = begin + size;
    return body_.data() + begin;
  }

  bool add(const std::string& path, std::string text, bool is_text) {
    if (out_.size() >= kMostValues) return false;
    out_.push_back({path, std::move(text), is_text});
    return true;
  }

  const Ros2Schema& schema_;
  std::span<const std::byte> body_;  // behind the encapsulation header
  bool swapped_;
  std::size_t most_alignment_;
  std::size_t position_ = 0;
  std::size_t steps_ = 0;
  FlatMessage out_;
};

Result<FlatMessage> Ros2Schema::flatten(std::span<const std::byte> cdr) const {
  constexpr std::size_t kHead = 4;
  if (cdr.size() < kHead) return fail("the message is shorter than the head of CDR");
  // The kind of encapsulation: 0 and 1 are CDR, big and little endian; 6 and 7 those of XCDR version 2.
  const auto kind = std::to_integer<unsigned>(cdr[1]);
  if (cdr[0] != std::byte{0} || (kind > 1 && kind != 6 && kind != 7))
    return fail(fmt::format("an encapsulation of kind {} is not supported", kind));
  const bool little = (kind & 1U) != 0;
  Values values(*this, cdr.subspan(kHead), little != (std::endian::native == std::endian::little), kind > 1 ? 4 : 8);
  if (!values.read(root_, {}))
    return fail(fmt::format("the message does not fit its schema {} at byte {}", root_, kHead + values.position()));
  return values.take_values();
}

namespace {

bool flatten_value(const nlohmann::json& value, const std::string& path, int depth, FlatMessage& out) {
  if (out.size() >= kMostValues || depth > kDeepest * 2) return false;
  if (value.is_object()) {
    for (const auto& [key, member] : value.items())
      if (!flatten_value(member, path.empty() ? key : path + "." + key, depth + 1, out)) return false;
    return true;
  }
  if (value.is_array()) {
    std::size_t i = 0;
    for (const nlohmann::json& element : value)
      if (!flatten_value(element, fmt::format("{}[{}]", path, i++), depth + 1, out)) return false;
    return true;
  }
  if (value.is_string()) {
    out.push_back({path, value.get<std::string>(), true});
  } else {
    out.push_back({path, value.is_null() ? std::string() : value.dump(), false});
  }
  return true;
}

}  // namespace

Result<FlatMessage> flatten_json(std::string_view text) {
  const nlohmann::json value = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (value.is_discarded()) return fail("the message is not JSON");
  FlatMessage out;
  if (!flatten_value(value, {}, 0, out)) return fail("the message is too deep or has too many values");
  return out;
}

}  // namespace cellmirror::app
