// Picture files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/image.hpp"

namespace cellmirror::app {

// By the extension: .png, .jpg, .jpeg.
[[nodiscard]] std::optional<ImageFormat> picture_format(std::string_view file_name);
// Whole or not at all: written beside it, then renamed.
[[nodiscard]] Result<void> write_picture_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

}  // namespace cellmirror::app
