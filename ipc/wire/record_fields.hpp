// Fields that several kinds of records share: texts of a fixed room, points, reserved bytes. The caller has checked the
// bounds.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "rt_core/base/result.hpp"

namespace cellmirror {

using PointRecord = std::array<double, 3>;  // m, in the world

// A name in a field of `room` bytes: at least one NUL behind it, filled up with NULs. A longer one loses its end,
// between characters.
void put_name(std::span<std::byte> bytes, std::size_t offset, std::size_t room, std::string_view name);
// A dotted path: both ends distinguish paths, so a longer one gets "..." in its middle; its first name stays. `room` is
// at least 16.
void put_path(std::span<std::byte> bytes, std::size_t offset, std::size_t room, std::string_view path);
// Fails for text without its NUL and for bytes behind it.
[[nodiscard]] Result<std::string> get_text(std::span<const std::byte> bytes, std::size_t offset, std::size_t room);

void put_point(std::span<std::byte> bytes, std::size_t offset, const PointRecord& point);
[[nodiscard]] PointRecord get_point(std::span<const std::byte> bytes, std::size_t offset);

[[nodiscard]] bool all_zero(std::span<const std::byte> bytes);

}  // namespace cellmirror
