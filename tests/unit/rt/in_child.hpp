// Runs a function in a child process whose rights or limits the test takes away, and hands its answer back as text.
#pragma once

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <functional>
#include <string>

namespace cellmirror {

inline std::string in_child(const std::function<std::string()>& function) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) {
    return "no pipe";
  }
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    const std::string answer = function();
    const bool written = write(ends[1], answer.data(), answer.size()) == static_cast<ssize_t>(answer.size());
    _exit(written ? 0 : 1);
  }
  close(ends[1]);
  std::string answer;
  std::array<char, 512> buffer{};
  for (ssize_t n = 0; (n = read(ends[0], buffer.data(), buffer.size())) > 0;) {
    answer.append(buffer.data(), static_cast<std::size_t>(n));
  }
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? answer : "the child died, after: " + answer;
}

// An ordinary user: no capabilities, no real-time priority, at most `memlock_bytes` locked.
inline bool become_ordinary_user(std::uint64_t memlock_bytes) {
  const rlimit none{0, 0};
  const rlimit memlock{memlock_bytes / 2, memlock_bytes};
  constexpr uid_t kNobody = 65534;
  return setrlimit(RLIMIT_RTPRIO, &none) == 0 && setrlimit(RLIMIT_MEMLOCK, &memlock) == 0 && setgid(kNobody) == 0 &&
         setuid(kNobody) == 0;
}

}  // namespace cellmirror
