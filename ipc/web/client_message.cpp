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

// Reads members of an object and keeps the first error.
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
      refuse(fmt::format("{} is not between {} and {}", name, min, max));
      return otherwise;
    }
    if (!found->is_number_integer()) {
      refuse(fmt::format("{} is not an integer", name));
      return otherwise;
    }
    const auto value = found->get<std::int64_t>();
    if (value >= min && value <= max) return value;
    refuse(fmt::format("{} is not between {} and {}", name, min, max));
    return otherwise;
  }

  double number(const char* name, double otherwise) {
    const auto found = object_.find(name);
    if (found == object_.end()) return otherwise;
    if (!found->is_number()) {
      refuse(fmt::format("{} is not a number", name));
      return otherwise;
    }
    return found->get<double>();
  }

  std::string text(const char* name, std::size_t most) {
    const auto found = object_.find(name);
    if (found == object_.end()) return {};
    if (!found->is_string() || found->get_ref<const std::string&>().size() > most) {
      refuse(fmt::format("{} is not a string of at most {} bytes", name, most));
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
      refuse(fmt::format("{} is not an array of three numbers", name));
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
    fields.refuse("free is not an object");
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

PictureRequest read_picture(Fields& fields) {
  PictureRequest request;
  if (fields.has("view")) request.view = static_cast<int>(fields.whole("view", 0, 0, 6));
  if (fields.has("camera")) request.camera = fields.text("camera", kLongestName);
  request.free_view = read_free_view(fields);
  request.width = static_cast<int>(fields.whole("width", request.width, 1, kLargestImageEdge));
  request.height = static_cast<int>(fields.whole("height", request.height, 1, kLargestImageEdge));
  request.rate_hz = fields.number("rate_hz", request.rate_hz);
  request.quality = static_cast<int>(fields.whole("quality", request.quality, 1, 100));
  return request;
}

CommandMessage read_command(Fields& fields, std::int64_t id) {
  CommandMessage out{id, fields.text("text", kMaxCommandBytes)};
  if (trimmed(out.text).empty()) fields.refuse("text contains no command");
  if (out.text.find('\0') != std::string::npos) fields.refuse("the command contains a NUL");
  return out;
}

PickMessage read_pick(Fields& fields, std::int64_t id) {
  return {id, static_cast<int>(fields.whole("x", 0, 0, kLargestImageEdge)),
          static_cast<int>(fields.whole("y", 0, 0, kLargestImageEdge))};
}

std::uint32_t read_sequence(Fields& fields) {
  constexpr std::int64_t kMost = std::numeric_limits<std::uint32_t>::max();
  return static_cast<std::uint32_t>(fields.whole("sequence", 0, 0, kMost));
}

PlaybackMessage read_playback(Fields& fields) {
  PlaybackMessage out;
  if (fields.has("play")) {
    if (!fields["play"].is_boolean()) fields.refuse("play is neither true nor false");
    out.play = fields["play"].is_boolean() && fields["play"].get<bool>();
  }
  if (fields.has("speed")) out.speed = fields.number("speed", 1);
  if (fields.has("seek_s")) out.seek_s = fields.number("seek_s", 0);
  return out;
}

ClientMessage read_by_name(Fields& fields, std::string_view name, std::int64_t id) {
  constexpr std::size_t kLongestToken = 128;
  if (name == "hello") return HelloMessage{fields.text("token", kLongestToken)};
  if (name == "picture") {
    const PictureMessage message{read_picture(fields)};
    if (const auto good = check_picture_request(message.request); !good) fields.refuse(good.error().text());
    return message;
  }
  if (name == "shown") return ShownMessage{read_sequence(fields)};
  if (name == "scene") return SceneMessage{};
  if (name == "no_scene") return NoSceneMessage{};
  if (name == "posed") return PosedMessage{read_sequence(fields)};
  if (name == "command") return read_command(fields, id);
  if (name == "pick") return read_pick(fields, id);
  if (name == "playback") return read_playback(fields);
  if (name != "no_picture")
    fields.refuse(fmt::format(
        "do is \"{}\"; expected hello, picture, no_picture, shown, scene, no_scene, posed, command, pick or playback",
        printable(name, 32)));
  return NoPictureMessage{};
}

bool within(const Eigen::Vector3d& p) { return p.allFinite() && p.cwiseAbs().maxCoeff() <= kFarthest; }

Result<void> check_free_view(const View& view) {
  constexpr double kNarrowest = 1e-3;  // rad
  constexpr double kWidest = 3.1;
  if (!within(view.viewpoint) || !within(view.lookpoint))
    return fail("the free view is more than 10 km from the origin");
  if ((view.viewpoint - view.lookpoint).norm() < 1e-6)
    return fail("viewpoint and lookpoint of the free view are the same");
  if (!std::isfinite(view.twist) || std::abs(view.twist) > 100.0) return fail("twist_rad is out of range");
  if (!(view.opening_angle >= kNarrowest && view.opening_angle <= kWidest))
    return fail(fmt::format("opening_angle_rad is not between {} and {}", kNarrowest, kWidest));
  return {};
}

}  // namespace

Result<void> check_picture_request(const PictureRequest& request) {
  if (int{request.view.has_value()} + int{request.camera.has_value()} + int{request.free_view.has_value()} > 1)
    return fail("only one of view, camera and free may be given");
  const bool size_good = request.width >= kSmallestPictureEdge && request.width <= kLargestPictureWidth &&
                         request.height >= kSmallestPictureEdge && request.height <= kLargestPictureHeight;
  if (!size_good)
    return fail(fmt::format("pictures have {} to {} by {} to {} pixels", kSmallestPictureEdge, kLargestPictureWidth,
                            kSmallestPictureEdge, kLargestPictureHeight));
  if (request.view && (*request.view < 0 || *request.view > 6)) return fail("views are 0 to 6");
  if (!(request.rate_hz >= kFewestPicturesPerSecond && request.rate_hz <= kMostPicturesPerSecond)) {
    return fail(fmt::format("rate_hz is not between {} and {}", kFewestPicturesPerSecond, kMostPicturesPerSecond));
  }
  if (request.quality < 1 || request.quality > 100) return fail("quality is not between 1 and 100");
  return request.free_view ? check_free_view(*request.free_view) : Result<void>{};
}

std::expected<ClientMessage, BadMessage> read_client_message(std::string_view text) {
  const json document = json::parse(text, nullptr, false);
  if (!document.is_object()) return std::unexpected(BadMessage{0, "the message is not a JSON object"});
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
  if (!parts) return fail("the query of the URL is malformed");
  PictureRequest request;
  for (const auto& [name, value] : *parts) {
    const auto number = parse_integer(value);
    const bool small = number && *number >= 0 && *number <= kLargestImageEdge;
    if (name == "camera") {
      request.camera = value;
    } else if (name != "view" && name != "width" && name != "height" && name != "quality") {
      return fail(fmt::format("unknown parameter {}", printable(name, 32)),
                  "expected: view, camera, width, height, quality");
    } else if (!small) {
      return fail(fmt::format("{} is not a number in range", name));
    } else if (name == "view") {
      request.view = static_cast<int>(*number);
    } else {
      (name == "width"    ? request.width
       : name == "height" ? request.height
                          : request.quality) = static_cast<int>(*number);
    }
  }
  if (const auto good = check_picture_request(request); !good) return std::unexpected(good.error());
  return request;
}

}  // namespace cellmirror::web
