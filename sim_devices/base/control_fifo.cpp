#include "sim_devices/base/control_fifo.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string_view>
#include <system_error>

namespace cellmirror::sim {
namespace {

constexpr std::size_t kLongestLine = 16384;

}  // namespace

Result<std::unique_ptr<ControlFifo>> ControlFifo::open(const std::string& path) {
  struct stat found{};
  if (::stat(path.c_str(), &found) != 0 || !S_ISFIFO(found.st_mode)) {
    return fail(fmt::format("--control {}: no FIFO", path), fmt::format("mkfifo {}", path));
  }
  // Open for writing too: otherwise a FIFO without a writer reads as ended.
  Descriptor fifo(::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
  if (!fifo.valid()) {
    return fail(fmt::format("--control {}: {}", path, std::generic_category().message(errno)));
  }
  return std::unique_ptr<ControlFifo>(new ControlFifo(std::move(fifo)));
}

std::vector<std::string> ControlFifo::lines() {
  std::vector<std::string> whole;
  std::array<char, 4096> buffer;
  const ssize_t got = ::read(fifo_.get(), buffer.data(), buffer.size());
  if (got <= 0) return whole;
  partial_.append(buffer.data(), static_cast<std::size_t>(got));
  for (std::size_t end = partial_.find('\n'); end != std::string::npos; end = partial_.find('\n')) {
    whole.push_back(partial_.substr(0, end));
    partial_.erase(0, end + 1);
  }
  if (partial_.size() > kLongestLine) partial_.clear();
  return whole;
}

}  // namespace cellmirror::sim
