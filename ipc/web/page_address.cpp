#include "ipc/web/page_address.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "ipc/runtime/system_error.hpp"
#include "rt_core/base/descriptor.hpp"
#include "rt_core/base/home.hpp"

namespace cellmirror::web {

namespace {

using nlohmann::json;

constexpr std::size_t kLargestFile = 4096;
constexpr std::size_t kTokenDigits = 32;

Result<void> write_private(const std::filesystem::path& file, const std::string& text) {
  ::unlink(file.c_str());
  const Descriptor out(::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600));
  if (!out.valid() || ::write(out.get(), text.data(), text.size()) != static_cast<ssize_t>(text.size()))
    return fail(fmt::format("cannot write {}: {}", file.native(), system_error_text(errno)));
  return {};
}

// Empty where the file is not this user's own or contains anything else.
std::string read_token(const std::filesystem::path& file) {
  const Descriptor in(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  struct stat facts{};
  if (!in.valid() || ::fstat(in.get(), &facts) != 0 || !S_ISREG(facts.st_mode)) return {};
  if (facts.st_uid != ::geteuid() || (facts.st_mode & 0077U) != 0) return {};
  std::array<char, kTokenDigits + 1> bytes{};
  const ssize_t got = ::read(in.get(), bytes.data(), bytes.size());
  const std::string text(bytes.data(), static_cast<std::size_t>(std::max<ssize_t>(0, got)));
  const bool good = text.size() == kTokenDigits && text.find_first_not_of("0123456789abcdef") == std::string::npos;
  return good ? text : std::string();
}

}  // namespace

std::string PageAddress::url() const {
  // A server on all addresses is reached by loopback.
  const std::string host = address == "0.0.0.0" ? "127.0.0.1" : address == "::" ? "::1" : address;
  const bool six = host.find(':') != std::string::npos;
  return fmt::format(fmt::runtime(six ? "http://[{}]:{}/" : "http://{}:{}/"), host, port);
}

std::string PageAddress::url_with_token() const { return read_only ? url() : url() + "#token=" + token; }

Result<std::string> make_token() {
  std::array<std::uint8_t, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    return fail(fmt::format("no random numbers from the kernel: {}", system_error_text(errno)));
  std::string out;
  for (const std::uint8_t byte : bytes) out += fmt::format("{:02x}", byte);
  return out;
}

Result<void> write_page_address(const std::filesystem::path& folder, const PageAddress& page) {
  const auto file = folder / kPageAddressFile;
  const json document = {
      {"address", page.address}, {"port", page.port}, {"token", page.token}, {"read_only", page.read_only}};
  const std::string text = document.dump() + "\n";
  return write_private(file, text);
}

Result<std::string> kept_token(const std::filesystem::path& file) {
  std::string token = read_token(file);
  if (!token.empty()) return token;
  auto made = make_token();
  if (!made) return made;
  // If it cannot be stored, it is valid for this run alone.
  static_cast<void>(write_private(file, *made));
  return made;
}

Result<PageAddress> read_page_address(const std::filesystem::path& folder) {
  const auto file = folder / kPageAddressFile;
  const auto text = read_text_file(file, kLargestFile);
  if (!text) return fail("this gateway has no monitor page", "start it without --no-web");
  const json document = json::parse(*text, nullptr, false);
  const auto is = [&](const char* name, json::value_t type) {
    return document.contains(name) && document.at(name).type() == type;
  };
  if (!document.is_object() || !is("address", json::value_t::string) || !is("port", json::value_t::number_unsigned) ||
      !is("token", json::value_t::string) || !is("read_only", json::value_t::boolean))
    return fail(fmt::format("{} is not valid", file.native()), "restart that gateway with this version");
  return PageAddress{document.at("address").get<std::string>(), document.at("port").get<int>(),
                     document.at("token").get<std::string>(), document.at("read_only").get<bool>()};
}

}  // namespace cellmirror::web
