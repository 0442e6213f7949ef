// errno in words.
#pragma once

#include <string>

namespace cellmirror {

// "No such file or directory", thread-safe.
[[nodiscard]] std::string system_error_text(int error_number);

}  // namespace cellmirror
