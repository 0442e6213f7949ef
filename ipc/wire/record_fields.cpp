#include "ipc/wire/record_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>

#include "ipc/wire/little_endian.hpp"
#include "rt_core/base/utf8.hpp"

namespace cellmirror {
namespace {

constexpr std::string_view kMiddleCut = "...";

// A NUL within a text would hide the rest from the reader's own check.
std::string_view before_nul(std::string_view text) { return text.substr(0, text.find('\0')); }

bool continues_character(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

void put_text(std::span<std::byte> bytes, std::size_t offset, std::size_t room,
              std::initializer_list<std::string_view> parts) {
  const auto field = bytes.subspan(offset, room);
  std::fill(field.begin(), field.end(), std::byte{0});
  auto next = field.begin();
  for (const std::string_view part : parts)
    next = std::transform(part.begin(), part.end(), next, [](char c) { return static_cast<std::byte>(c); });
}

}  // namespace

void put_name(std::span<std::byte> bytes, std::size_t offset, std::size_t room, std::string_view name) {
  put_text(bytes, offset, room, {cut_utf8(before_nul(name), room - 1)});
}

void put_path(std::span<std::byte> bytes, std::size_t offset, std::size_t room, std::string_view path) {
  path = before_nul(path);
  if (path.size() < room) return put_name(bytes, offset, room, path);
  // A name has 63 bytes at most; what is no path may have more.
  const std::string_view first = cut_utf8(path.substr(0, path.find('.')), room / 2 - 1);
  std::string_view end = path.substr(path.size() - (room - 1 - kMiddleCut.size() - first.size()));
  while (!end.empty() && continues_character(end.front())) end.remove_prefix(1);
  put_text(bytes, offset, room, {first, kMiddleCut, end});
}

Result<std::string> get_text(std::span<const std::byte> bytes, std::size_t offset, std::size_t room) {
  const auto field = bytes.subspan(offset, room);
  const auto end = std::find(field.begin(), field.end(), std::byte{0});
  if (end == field.end()) return fail(fmt::format("the text at byte {} is not terminated by a NUL", offset));
  if (!all_zero({end, field.end()})) return fail(fmt::format("the text at byte {} continues after its NUL", offset));
  std::string text(static_cast<std::size_t>(end - field.begin()), '\0');
  std::transform(field.begin(), end, text.begin(), [](std::byte b) { return static_cast<char>(b); });
  return text;
}

void put_point(std::span<std::byte> bytes, std::size_t offset, const PointRecord& point) {
  for (std::size_t i = 0; i < point.size(); ++i) little_endian::put(bytes, offset + sizeof(double) * i, point[i]);
}

PointRecord get_point(std::span<const std::byte> bytes, std::size_t offset) {
  PointRecord point;
  for (std::size_t i = 0; i < point.size(); ++i) {
    point[i] = little_endian::get<double>(bytes, offset + sizeof(double) * i);
  }
  return point;
}

bool all_zero(std::span<const std::byte> bytes) {
  return std::all_of(bytes.begin(), bytes.end(), [](std::byte b) { return b == std::byte{0}; });
}

}  // namespace cellmirror
