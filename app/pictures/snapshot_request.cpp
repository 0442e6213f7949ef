#include "app/pictures/snapshot_request.hpp"

#include <fmt/format.h>

#include <charconv>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "rt_core/base/base64.hpp"
#include "rt_core/base/json_writer.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace {

Result<int> whole_number(const std::string& name, const std::string& text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc{} && end == text.data() + text.size()) return value;
  return fail(fmt::format("\"{}\": {} is no whole number", name, printable(text)));
}

Result<void> take(const std::string& name, const std::string& text, SnapshotRequest& wanted) {
  if (name == "camera") {
    wanted.camera = text;
    return {};
  }
  if (name == "format") {
    if (text != "png" && text != "jpeg")
      return fail(fmt::format("\"format\": {} is not known", printable(text)), "known: png, jpeg");
    wanted.format = text == "png" ? ImageFormat::png : ImageFormat::jpeg;
    return {};
  }
  if (name != "view" && name != "width" && name != "height" && name != "quality") {
    return fail(fmt::format("a picture has no \"{}\"", printable(name)),
                "known: view, camera, width, height, quality, format");
  }
  const auto number = whole_number(name, text);
  if (!number) return std::unexpected(number.error());
  if (name == "view") wanted.view = *number;
  if (name == "width") wanted.width = *number;
  if (name == "height") wanted.height = *number;
  if (name == "quality") wanted.quality = *number;
  return {};
}

const char* word(ImageFormat format) { return format == ImageFormat::png ? "png" : "jpeg"; }

}  // namespace

ControlRequest question(const SnapshotRequest& wanted) {
  ControlRequest request{"snapshot", {}};
  const auto add = [&](const char* name, const std::optional<int>& value) {
    if (value) request.arguments.emplace_back(name, std::to_string(*value));
  };
  add("view", wanted.view);
  add("width", wanted.width);
  add("height", wanted.height);
  add("quality", wanted.quality);
  if (wanted.camera) request.arguments.emplace_back("camera", *wanted.camera);
  request.arguments.emplace_back("format", word(wanted.format));
  return request;
}

Result<SnapshotRequest> snapshot_request(const ControlRequest& request) {
  SnapshotRequest wanted;
  for (const auto& [name, text] : request.arguments) {
    if (auto taken = take(name, text, wanted); !taken) return std::unexpected(taken.error());
  }
  return wanted;
}

PictureRequest picture_request_of(const SnapshotRequest& wanted, int width, int height) {
  PictureRequest request;
  request.view = wanted.view;
  request.camera = wanted.camera;
  request.width = wanted.width.value_or(width);
  request.height = wanted.height.value_or(height);
  request.quality = wanted.quality;
  return request;
}

std::string answer_text(const EncodedImage& picture, double posture_age_s) {
  JsonWriter out;
  return out.begin_object()
      .member("format", word(picture.format))
      .member("width", picture.width)
      .member("height", picture.height)
      .member("sequence", picture.sequence)
      .fixed_member("posture_age_s", posture_age_s, 6)
      .member("data", base64(picture.bytes))
      .end_object()
      .take();
}

Result<SnapshotAnswer> snapshot_answer(std::string_view text) {
  constexpr const char* kRemedy = "is the gateway of another version?";
  try {
    const auto document = nlohmann::json::parse(text);
    SnapshotAnswer answer;
    answer.format = document.at("format").get<std::string>() == "png" ? ImageFormat::png : ImageFormat::jpeg;
    const auto whole = [&](const char* name, std::uint64_t most) {
      const auto& value = document.at(name);
      const bool fits = value.is_number_unsigned() && value.get<std::uint64_t>() <= most;
      return fits ? std::optional(value.get<std::uint64_t>()) : std::nullopt;
    };
    constexpr std::uint64_t kLongestSide = std::numeric_limits<int>::max();
    const auto width = whole("width", kLongestSide);
    const auto height = whole("height", kLongestSide);
    const auto sequence = whole("sequence", std::numeric_limits<std::uint64_t>::max());
    if (!width || !height || !sequence)
      return fail("the gateway's answer is no picture: its numbers do not fit", kRemedy);
    answer.width = static_cast<int>(*width);
    answer.height = static_cast<int>(*height);
    answer.sequence = *sequence;
    answer.posture_age_s = document.at("posture_age_s").get<double>();
    auto bytes = from_base64(document.at("data").get_ref<const std::string&>());
    if (!bytes) return fail("the gateway's picture is damaged", kRemedy);
    answer.bytes = std::move(*bytes);
    return answer;
  } catch (const nlohmann::json::exception& error) {
    return fail(fmt::format("the gateway's answer is no picture: {}", error.what()), kRemedy);
  }
}

}  // namespace cellmirror::app
