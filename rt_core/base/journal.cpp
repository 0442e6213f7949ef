#include "rt_core/base/journal.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <iterator>

namespace cellmirror {

namespace {

// NAME=value, or, where the value has lines, NAME, a line feed, its length in 64 bits, little-endian, and the value.
void add_field(std::string& out, std::string_view name, std::string_view value) {
  out += name;
  if (value.find('\n') == std::string_view::npos) {
    out += '=';
  } else {
    out += '\n';
    constexpr unsigned kBits = 64;
    for (unsigned shift = 0; shift < kBits; shift += 8)
      out += static_cast<char>((static_cast<std::uint64_t>(value.size()) >> shift) & 0xFFU);
  }
  out += value;
  out += '\n';
}

}  // namespace

std::string journal_text(const JournalEntry& entry) {
  const std::size_t space = entry.kind.find(' ');
  std::string out;
  add_field(out, "SYSLOG_IDENTIFIER", "cellmirror");
  add_field(out, "PRIORITY", std::to_string(entry.priority));
  add_field(out, "CELLMIRROR_KIND", entry.kind.substr(0, space));
  if (space != std::string_view::npos) add_field(out, "CELLMIRROR_SUBJECT", entry.kind.substr(space + 1));
  if (entry.swallowed > 0) add_field(out, "CELLMIRROR_SWALLOWED", std::to_string(entry.swallowed));
  add_field(out, "MESSAGE", fmt::format("[{}] {}", entry.kind, entry.message));
  return out;
}

bool standard_error_is_journal(const char* journal_stream) {
  if (journal_stream == nullptr) return false;
  struct stat info{};
  return fstat(STDERR_FILENO, &info) == 0 && fmt::format("{}:{}", info.st_dev, info.st_ino) == journal_stream;
}

Journal::Journal(std::string_view socket_path) : path_(socket_path) {
  if (!path_.empty()) socket_ = Descriptor(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
}

bool Journal::send(const JournalEntry& entry) const {
  sockaddr_un to{};
  if (!socket_.valid() || path_.size() >= sizeof to.sun_path) return false;
  to.sun_family = AF_UNIX;
  std::ranges::copy(path_, std::begin(to.sun_path));
  const std::string text = journal_text(entry);
  const ssize_t sent = sendto(socket_.get(), text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT,
                              reinterpret_cast<const sockaddr*>(&to), sizeof to);
  return sent == static_cast<ssize_t>(text.size());
}

}  // namespace cellmirror
