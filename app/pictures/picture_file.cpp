#include "app/pictures/picture_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include "rt_core/base/text.hpp"

namespace cellmirror::app {

std::optional<ImageFormat> picture_format(std::string_view file_name) {
  const std::string name = lower_case(file_name);
  if (name.ends_with(".png")) return ImageFormat::png;
  if (name.ends_with(".jpg") || name.ends_with(".jpeg")) return ImageFormat::jpeg;
  return std::nullopt;
}

Result<void> write_picture_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
  const auto failed = [&] {
    return fail(fmt::format("{} cannot be written: {}", path.string(), std::strerror(errno)),
                "name a file in a folder of yours");
  };
  // A device or a pipe is written as it is.
  std::error_code error;
  const bool plain = !std::filesystem::exists(path, error) || std::filesystem::is_regular_file(path, error);
  std::filesystem::path beside = path;
  if (plain) beside += fmt::format(".{}.part", ::getpid());
  std::FILE* file = std::fopen(beside.c_str(), "wb");
  if (file == nullptr) return failed();
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  const bool closed = std::fclose(file) == 0;
  if (written && closed && (!plain || std::rename(beside.c_str(), path.c_str()) == 0)) return {};
  auto out = failed();
  if (plain) std::remove(beside.c_str());
  return out;
}

}  // namespace cellmirror::app
