#include "app/subcommands/resource_limits.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <system_error>

namespace cellmirror::app {

namespace {

// Streams, queues between threads, the page's 64 connections and those of the control socket, DDS.
constexpr rlim_t kLeastFiles = 256;
// Threads reserve their stacks, and DDS and the renderer their memory, long before it is used.
constexpr rlim_t kLeastAddressSpace = rlim_t{2} << 30;

std::string mebibytes(rlim_t bytes) { return fmt::format("{} MiB", bytes >> 20); }

Result<void> check_files() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= kLeastFiles) return {};
  limit.rlim_cur = std::min(kLeastFiles, limit.rlim_max);
  if (::setrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_cur >= kLeastFiles) return {};
  return fail(fmt::format("the limit of open files is {}, and a gateway needs {}", limit.rlim_cur, kLeastFiles),
              fmt::format("raise it with ulimit -n {}, or LimitNOFILE= in the systemd unit", 4 * kLeastFiles));
}

Result<void> check_address_space() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY || limit.rlim_cur >= kLeastAddressSpace)
    return {};
  return fail(fmt::format("the address space is limited to {}, and a gateway needs {}", mebibytes(limit.rlim_cur),
                          mebibytes(kLeastAddressSpace)),
              "raise it with ulimit -v unlimited, or LimitAS= in the systemd unit; to limit the memory in use set "
              "MemoryMax= there");
}

// No heap: there may be none left.
void say(const char* text) { [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text, std::strlen(text)); }

[[noreturn]] void end_where_resources_ran_out() {
  try {
    if (const std::exception_ptr failure = std::current_exception()) std::rethrow_exception(failure);
  } catch (const std::bad_alloc&) {
    say("cellmirror: out of memory; raise the limits (ulimit -v, ulimit -l, MemoryMax= of the systemd unit), or end "
        "other programs\n");
    ::_exit(1);
  } catch (const std::system_error& error) {
    say("cellmirror: the machine has no more threads, files or memory for the gateway: ");
    say(error.what());
    say("; raise the limits (ulimit -u, -n, -v)\n");
    ::_exit(1);
  } catch (const std::exception& error) {
    say("cellmirror: unexpected failure: ");
    say(error.what());
    say("; this is a bug, please report it\n");
  } catch (...) {
    say("cellmirror: unexpected failure; this is a bug, please report it\n");
  }
  std::abort();
}

}  // namespace

Result<void> check_resource_limits() {
  if (auto files = check_files(); !files) return files;
  return check_address_space();
}

void report_exhausted_resources() { std::set_terminate(end_where_resources_ran_out); }

}  // namespace cellmirror::app
