#include "drivers/mqtt/credentials.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "rt_core/base/descriptor.hpp"
#include "rt_core/base/utf8.hpp"

namespace cellmirror::mqtt {

namespace {

constexpr std::size_t kMostWordBytes = 1024;
constexpr std::size_t kMostFileBytes = 2 * kMostWordBytes + 4;
constexpr const char* kForm = "two lines: the user, the password";

std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

bool is_word(std::string_view word) {
  if (word.empty() || word.size() > kMostWordBytes) return false;
  while (!word.empty()) {
    const auto character = utf8_character(word);
    if (!character || is_control_character(character->code)) return false;
    word.remove_prefix(character->bytes);
  }
  return true;
}

}  // namespace

Result<Credentials> parse_credentials(std::string_view text) {
  Credentials out;
  out.user = take_line(text);
  out.password = take_line(text);
  if (!text.empty()) return fail("there is more behind the second line", kForm);
  if (!is_word(out.user)) return fail("its first line is no name of a user", kForm);
  if (!is_word(out.password)) return fail("its second line is no password", kForm);
  return out;
}

Result<Credentials> read_credentials(const std::string& file) {
  const auto failed = [&](const std::string& why, std::string remedy = {}) {
    return fail(fmt::format("the credentials in {} cannot be used: {}", file, why), std::move(remedy));
  };
  const Descriptor opened(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat state{};
  if (!opened.valid() || ::fstat(opened.get(), &state) != 0) return failed(std::strerror(errno));
  if (!S_ISREG(state.st_mode)) return failed("it is no file");
  if (state.st_uid != ::geteuid() && state.st_uid != 0)
    return failed("it is another user's", "chown it to the gateway's");
  if ((state.st_mode & (S_IRWXG | S_IRWXO)) != 0)
    return failed("others may read it", fmt::format("chmod 600 {}", file));
  std::array<char, kMostFileBytes + 1> bytes{};
  const ssize_t count = ::read(opened.get(), bytes.data(), bytes.size());
  if (count < 0) return failed(std::strerror(errno));
  if (static_cast<std::size_t>(count) > kMostFileBytes) return failed("it is too long", kForm);
  auto parsed = parse_credentials({bytes.data(), static_cast<std::size_t>(count)});
  if (!parsed) return failed(parsed.error().what, parsed.error().remedy);
  return parsed;
}

}  // namespace cellmirror::mqtt
