#include "app/live/asset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "ipc/web/http_request.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::app {

namespace fs = std::filesystem;

namespace {

constexpr std::array<std::string_view, 14> kKinds = {".urdf", ".stl", ".obj", ".mtl", ".dae",  ".ply", ".gltf",
                                                     ".glb",  ".bin", ".png", ".jpg", ".jpeg", ".bmp", ".tga"};

// Unreserved characters, and the slashes of the path.
bool is_plain(char c) {
  constexpr std::string_view kOthers = "-_.~/";
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         kOthers.find(c) != std::string_view::npos;
}

std::string encoded(std::string_view path) {
  std::string out;
  for (const char c : path)
    out += is_plain(c) ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  return out;
}

}  // namespace

std::string asset_uri(const KismetHome& home, std::string_view file) {
  const fs::path place = fs::path(file).lexically_relative(home.root());
  if (place.empty() || *place.begin() == "..") return {};
  return std::string(kCellPackage) + encoded(place.string());
}

Result<std::string> read_asset(const KismetHome& home, std::string_view uri, std::size_t most_bytes) {
  if (!uri.starts_with(kCellPackage)) {
    return fail(fmt::format("{} is no file of the cell", printable(uri)),
                fmt::format("files of the cell folder are {}PATH", kCellPackage));
  }
  const auto name = web::percent_decoded(uri.substr(kCellPackage.size()));
  if (!name || name->find('\0') != std::string::npos) return fail(fmt::format("{} is malformed", printable(uri)));
  const auto found = home.file("", *name);
  if (!found) return std::unexpected(found.error());
  // Of the file itself: a link by another name does not help.
  const std::string kind = lower_case(found->extension().string());
  if (std::ranges::find(kKinds, kind) == kKinds.end()) {
    return fail(fmt::format("{} is no description of robots, no mesh and no picture", printable(*name)),
                "only such files are given to clients");
  }
  return read_text_file(*found, most_bytes);
}

}  // namespace cellmirror::app
