// The file of credentials.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "drivers/mqtt/credentials.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto read = cellmirror::mqtt::parse_credentials({reinterpret_cast<const char*>(data), size});
  if (!read) return 0;
  if (read->user.empty() || read->password.empty() || read->user.find('\0') != std::string::npos ||
      read->password.find('\0') != std::string::npos)
    std::abort();
  return 0;
}
