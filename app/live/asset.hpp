// The files of a cell that clients may have: descriptions of robots, meshes and their pictures.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "rt_core/base/home.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::app {

// Files of the cell folder are "package://cell/PATH".
inline constexpr std::string_view kCellPackage = "package://cell/";
// The URDF of all robots, which is no file.
inline constexpr std::string_view kDescriptionUri = "package://cell/robot_description.urdf";

// The URI of a file, percent-encoded (RFC 3986); empty: it is not in the cell folder.
[[nodiscard]] std::string asset_uri(const KismetHome& home, std::string_view file);
// Its content, at most `most_bytes`. Refused: what is not in the cell folder, also through links, and all files that
// are no URDF, mesh or picture.
[[nodiscard]] Result<std::string> read_asset(const KismetHome& home, std::string_view uri, std::size_t most_bytes);

}  // namespace cellmirror::app
