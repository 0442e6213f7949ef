#include "ipc/web/client_message.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "ipc/web/http_request.hpp"
#include "rt_core/base/capacity.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::web {

namespace {

using nlohmann::json;

constexpr double kFarthest = 1e4;                // m
constexpr std::size_t kLongestName = 16 * 1024;  // a dotted path

// Collects the first mistake of a message.
class Fields {
 public:
  explicit Fields(const json& object) : object_(object) {}

  [[nodiscard]] bool has(const char* name) const { return object_.contains(name); }
  [[nodiscard]] const std::string& why() const { return why_; }
  void refuse(std::string why) {
    if (why_.empty()) why_ = std::move(why);
  }

  std::int64_t whole(const char* name, std::int64_t otherwise, std::int64_t min, std::int64_t max) {
    const auto found = object_.find(name);
    if (found == object_.end()) return otherwise;
    if (found->is_number_unsigned() && found->get<std::uint64_t>() > static_cast<std::uint64_t>(max)) {
      refuse(fmt::format("{} is not within {} and {}", name, min, max));
      return otherwise;
    }
    if (!found->is_number_integer()) {
      refuse(fmt::format("{} is no whole number", name));
      return otherwise;
    }
    const auto value = found->get<std::int64_t>();
    if (value >= min && value <= max) return value;
    refuse(fmt::format("{} is not within {} and {}", name, min, max));
    return otherwise;
  }

  double number(const char* name, double otherwise) {
    const auto found = object_.find(name);
    if (found == object_.end()) return otherwise;
    if (!found->is_number()) {
      refuse(fmt::format("{} is no number", name));
      return otherwise;
    }
    return found->get<double>();
  }

  std::string text(const char* name, std::size_t most) {
    const auto found = object_.find(name);
    if (found == object_.end()) return {};
    if (!found->is_string() || found->get_ref<const std::string&>().size() > most) {
      refuse(fmt::format("{} is no text of at most {} bytes", name, most));
      return {};
    }
    return found->get<std::string>();
  }

  Eigen::Vector3d point(const char* name) {
    const auto found = object_.find(name);
    Eigen::Vector3d out = Eigen::Vector3d::Zero();
    const bool good = found != object_.end() && found->is_array() && found->size() == 3 && (*found)[0].is_number() &&
                      (*found)[1].is_number() && (*found)[2].is_number();
    if (!good) {
      refuse(fmt::format("{} is no list of three numbers", name));
      return out;
    }
    for (int i = 0; i < 3; ++i) out[i] = (*found)[static_cast<std::size_t>(i)].get<double>();
    return out;
  }

  [[nodiscard]] const json& operator[](const char* name) const { return object_.at(name); }

 private:
  const json& object_;
  std::string why_;
};

std::optional<View> read_free_view(Fields& fields) {
  if (!fields.has("free")) return std::nullopt;
  const json& object = fields["free"];
  if (!object.is_object()) {
    fields.refuse("free is no object");
    return std::nullopt;
  }
  Fields view(object);
  View out;
  out.viewpoint = view.point("viewpoint_m");
  out.lookpoint = view.point("lookpoint_m");
  out.twist = view.number("twist_rad", 0);
  out.opening_angle = view.number("opening_angle_rad", out.opening_angle);
  if (!view.why().empty()) fields.refuse("free: " + view.why());
  return out;
}

PictureRequest read_wish(Fields& fields) {
  PictureRequest wish;
  if (fields.has("view")) wish.view = static_cast<int>(fields.whole("view", 0, 0, 6));
  if (fields.has("camera")) wish.camera = fields.text("camera", kLongestName);
  wish.free_view = read_free_view(fields);
  wish.width = static_cast<int>(fields.whole("width", wish.width, 1, kLargestImageEdge));
  wish.height = static_cast<int>(fields.whole("height", wish.height, 1, kLargestImageEdge));
  wish.rate_hz = fields.number("rate_hz", wish.rate_hz);
  wish.quality = static_cast<int>(fields.whole("quality", wish.quality, 1, 100));
  return wish;
}

CommandMessage read_command(Fields& fields, std::int64_t id) {
  CommandMessage out{id, fields.text("text", kMaxCommandBytes)};
  if (trimmed(out.text).empty()) fields.refuse("there is no command in text");
  if (out.text.find('\0') != std::string::npos) fields.refuse("the command holds a NUL");
  return out;
}

PickMessage read_pick(Fields& fields, std::int64_t id) {
  return {id, static_cast<int>(fields.whole("x", 0, 0, kLargestImageEdge)),
          static_cast<int>(fields.whole("y", 0, 0, kLargestImageEdge))};
}

ClientMessage read_by_name(Fields& fields, std::string_view name, std::int64_t id) {
  constexpr std::size_t kLongestToken = 128;
  if (name == "hello") return HelloMessage{fields.text("token", kLongestToken)};
  if (name == "picture") {
    const PictureMessage message{read_wish(fields)};
    if (const auto good = check_picture_wish(message.wish); !good) fields.refuse(good.error().text());
    return message;
  }
  if (name == "shown") {
    constexpr std::int64_t kMost = std::numeric_limits<std::uint32_t>::max();
    return ShownMessage{static_cast<std::uint32_t>(fields.whole("sequence", 0, 0, kMost))};
  }
  if (name == "command") return read_command(fields, id);
  if (name == "pick") return read_pick(fields, id);
  if (name != "no_picture")
    fields.refuse(fmt::format("do is \"{}\"; known are hello, picture, no_picture, shown, command and pick",
                              printable(name, 32)));
  return NoPictureMessage{};
}

bool within(const Eigen::Vector3d& p) { return p.allFinite() && p.cwiseAbs().maxCoeff() <= kFarthest; }

Result<void> check_free_view(const View& view) {
  constexpr double kNarrowest = 1e-3;  // rad
  constexpr double kWidest = 3.1;
  if (!within(view.viewpoint) || !within(view.lookpoint)) return fail("the free view is too far away");
  if ((view.viewpoint - view.lookpoint).norm() < 1e-6) return fail("the free view's viewpoint is its lookpoint");
  if (!std::isfinite(view.twist) || std::abs(view.twist) > 100.0) return fail("twist_rad is out of bounds");
  if (!(view.opening_angle >= kNarrowest && view.opening_angle <= kWidest))
    return fail(fmt::format("opening_angle_rad is not within {} and {}", kNarrowest, kWidest));
  return {};
}

}  // namespace

Result<void> check_picture_wish(const PictureRequest& wish) {
  if (int{wish.view.has_value()} + int{wish.camera.has_value()} + int{wish.free_view.has_value()} > 1)
    return fail("more than one of view, camera and free is given");
  const bool size_good = wish.width >= kSmallestPictureEdge && wish.width <= kLargestPictureWidth &&
                         wish.height >= kSmallestPictureEdge && wish.height <= kLargestPictureHeight;
  if (!size_good)
    return fail(fmt::format("pictures have {} to {} by {} to {} pixels", kSmallestPictureEdge, kLargestPictureWidth,
                            kSmallestPictureEdge, kLargestPictureHeight));
  if (wish.view && (*wish.view < 0 || *wish.view > 6)) return fail("views are 0 to 6");
  if (!(wish.rate_hz >= kFewestPicturesPerSecond && wish.rate_hz <= kMostPicturesPerSecond)) {
    return fail(fmt::format("rate_hz is not within {} and {}", kFewestPicturesPerSecond, kMostPicturesPerSecond));
  }
  if (wish.quality < 1 || wish.quality > 100) return fail("quality is not within 1 and 100");
  return wish.free_view ? check_free_view(*wish.free_view) : Result<void>{};
}

std::expected<ClientMessage, BadMessage> read_client_message(std::string_view text) {
  const json document = json::parse(text, nullptr, false);
  if (!document.is_object()) return std::unexpected(BadMessage{0, "the message is no JSON object"});
  Fields fields(document);
  constexpr std::int64_t kGreatestId = std::int64_t{1} << 53U;  // what JavaScript counts exactly
  const std::int64_t id = fields.whole("id", 0, 0, kGreatestId);
  const std::string name = fields.text("do", 64);
  ClientMessage message = read_by_name(fields, name, id);
  if (!fields.why().empty()) return std::unexpected(BadMessage{id, fields.why()});
  return message;
}

Result<PictureRequest> read_picture_query(std::string_view query) {
  const auto parts = query_parts(query);
  if (!parts) return fail("the address is malformed behind the question mark");
  PictureRequest wish;
  for (const auto& [name, value] : *parts) {
    const auto number = parse_integer(value);
    const bool small = number && *number >= 0 && *number <= kLargestImageEdge;
    if (name == "camera") {
      wish.camera = value;
    } else if (name != "view" && name != "width" && name != "height" && name != "quality") {
      return fail(fmt::format("{} is not known", printable(name, 32)), "known: view, camera, width, height, quality");
    } else if (!small) {
      return fail(fmt::format("{} is no number in range", name));
    } else if (name == "view") {
      wish.view = static_cast<int>(*number);
    } else {
      (name == "width" ? wish.width : name == "height" ? wish.height : wish.quality) = static_cast<int>(*number);
    }
  }
  if (const auto good = check_picture_wish(wish); !good) return std::unexpected(good.error());
  return wish;
}

}  // namespace cellmirror::web
