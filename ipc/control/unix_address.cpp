#include "ipc/control/unix_address.hpp"

#include <fmt/format.h>
#include <sys/socket.h>

#include <algorithm>
#include <string>

namespace cellmirror {

Result<sockaddr_un> unix_address(const std::filesystem::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string& text = path.native();
  if (text.size() >= sizeof address.sun_path) {
    return fail(fmt::format("the socket's path {} is longer than {} bytes", text, sizeof address.sun_path - 1),
                "set CELLMIRROR_RUNTIME_DIR to a shorter folder");
  }
  std::copy(text.begin(), text.end(), address.sun_path);
  return address;
}

}  // namespace cellmirror
