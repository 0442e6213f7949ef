// Files of lines that are appended to over restarts. Only the user of the gateway can read them (0600), and nothing
// else is written into by mistake. Not for the tick.
#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <filesystem>
#include <string>
#include <string_view>

#include "rt_core/base/descriptor.hpp"

namespace cellmirror::app {

struct LineFile {
  Descriptor file;          // appends
  std::uint64_t bytes = 0;  // in it
};

// Makes it where it is missing, in a folder that exists. Refused, with the reason: what is reached through a link, is
// no plain file with one name, or belongs to another user. A cut last line is ended.
[[nodiscard]] std::expected<LineFile, std::string> open_line_file(const std::filesystem::path& file);

// False, with errno, where not all of it could be written.
[[nodiscard]] bool write_all(int file, std::string_view text);

// The end of a plain file, at most so many bytes of it, so that the first line may be cut; empty where it cannot be
// read.
[[nodiscard]] std::string tail_of(const std::filesystem::path& file, std::size_t most_bytes);

}  // namespace cellmirror::app
