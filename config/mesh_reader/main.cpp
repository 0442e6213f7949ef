// cellmirror-mesh-reader: one request from the socket at descriptor 0, one answer to it at 1, and the end.
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <string_view>

#include "config/mesh_message/mesh_message.hpp"
#include "config/mesh_reader/mesh_importer.hpp"
#include "ipc/sandbox/confinement.hpp"
#include "rt_core/base/text.hpp"

// With AddressSanitizer, which does not work with an address limit: the largest permitted allocation.
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() { return "max_allocation_size_mb=3072:detect_leaks=0"; }

namespace cellmirror {
namespace {

std::optional<std::string> received() {
  std::string out;
  constexpr std::size_t kAtOnce = 64UL << 10U;
  static std::array<char, kAtOnce> part;
  while (true) {
    const ssize_t count = read(STDIN_FILENO, part.data(), part.size());
    if (count > 0) out.append(part.data(), static_cast<std::size_t>(count));
    if (count == 0) return out;
    if (count < 0 && errno != EINTR) return std::nullopt;
  }
}

bool write_all(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = write(STDOUT_FILENO, bytes.data(), bytes.size());
    if (count > 0) bytes.remove_prefix(static_cast<std::size_t>(count));
    if (count < 0 && errno != EINTR) return false;
  }
  return true;
}

Result<ScenePolygons> read_one() {
  try {
    const auto bytes = received();
    const auto request = bytes ? decode_mesh_request(*bytes) : std::nullopt;
    if (!request) return fail("it cannot be read: its reader does not understand the request");
    return import_mesh(*request);
  } catch (const std::bad_alloc&) {
    return fail("it cannot be read: its reader ran out of memory", "export it again, or reduce the mesh");
  } catch (const std::exception& exception) {
    return fail("it cannot be read: " + printable(exception.what()));
  } catch (...) {
    return fail("it cannot be read");
  }
}

int run() {
  // The largest files that are allowed take up to 0.8 GB (docs/decisions/0017).
  confine_this_process({});
  const Result<ScenePolygons> answer = read_one();
  const MeshMessage message = encode_mesh_answer(answer);
  for (const std::string_view part : message.parts()) {
    if (!write_all(part)) return 1;
  }
  return 0;
}

}  // namespace
}  // namespace cellmirror

// Nothing of what a library would do at the end is worth doing.
int main() { _exit(cellmirror::run()); }
