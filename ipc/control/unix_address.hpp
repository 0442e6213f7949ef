// The address of a Unix-domain socket.
#pragma once

#include <sys/un.h>

#include <filesystem>

#include "rt_core/base/result.hpp"

namespace cellmirror {

// Refused where the path is longer than the kernel takes (107 bytes).
[[nodiscard]] Result<sockaddr_un> unix_address(const std::filesystem::path& path);

}  // namespace cellmirror
