#include "drivers/mqtt/session_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <system_error>

#include "rt_core/base/descriptor.hpp"

namespace cellmirror::mqtt {

namespace {

std::unexpected<Error> system_failure(std::string_view what, const std::string& file) {
  return fail(fmt::format("{} {}: {}", what, file, std::strerror(errno)));
}

}  // namespace

Result<std::optional<std::uint8_t>> read_session(const std::string& file) {
  const Descriptor opened(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  if (!opened.valid() && errno == ENOENT) return std::nullopt;
  if (!opened.valid()) return system_failure("cannot read", file);
  std::array<char, 8> text{};
  const ssize_t length = ::read(opened.get(), text.data(), text.size());
  if (length < 0) return system_failure("cannot read", file);
  const char* const end = text.data() + length;
  std::uint8_t session = 0;
  const auto [stop, error] = std::from_chars(text.data(), end, session);
  if (error != std::errc() || std::string_view(stop, end) != "\n")
    return fail(fmt::format("{} does not contain a number from 0 to 255", file), "remove the file");
  return session;
}

Result<void> write_session(const std::string& file, std::uint8_t session) {
  constexpr int kMode = 0600;
  const std::string temporary = file + ".tmp";
  ::unlink(temporary.c_str());  // of a run that was killed
  const Descriptor opened(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, kMode));
  if (!opened.valid()) return system_failure("cannot write", temporary);
  const std::string text = fmt::format("{}\n", session);
  if (::write(opened.get(), text.data(), text.size()) != static_cast<ssize_t>(text.size()) ||
      ::fsync(opened.get()) != 0)
    return system_failure("cannot write", temporary);
  if (std::rename(temporary.c_str(), file.c_str()) != 0) return system_failure("cannot replace", file);
  return {};
}

}  // namespace cellmirror::mqtt
