#include "tests/integration/ipc/child_process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>

namespace cellmirror::test {

ChildProcess::ChildProcess(std::vector<std::string> command) {
  int out[2];
  int err[2];
  if (::pipe2(out, O_CLOEXEC) != 0 || ::pipe2(err, O_CLOEXEC) != 0) std::abort();
  std::vector<char*> arguments;
  for (std::string& word : command) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_ = ::fork();
  if (pid_ == 0) {
    ::dup2(out[1], STDOUT_FILENO);
    ::dup2(err[1], STDERR_FILENO);
    ::execvp(arguments[0], arguments.data());
    _exit(127);
  }
  ::close(out[1]);
  ::close(err[1]);
  out_ = out[0];
  err_ = err[0];
}

ChildProcess::~ChildProcess() {
  if (pid_ > 0) {
    ::kill(pid_, SIGTERM);
    bool ended = false;
    for (int i = 0; i < 60'000 && !ended; ++i) {
      ended = ::waitpid(pid_, nullptr, WNOHANG) != 0;
      if (!ended) ::usleep(1000);
    }
    if (!ended) end(SIGKILL);
  }
  ::close(out_);
  ::close(err_);
}

bool ChildProcess::read_more() {
  std::array<char, 4096> chunk;
  const ssize_t got = ::read(out_, chunk.data(), chunk.size());
  if (got <= 0) return false;
  output_.append(chunk.data(), static_cast<std::size_t>(got));
  return true;
}

std::string ChildProcess::line() {
  while (output_.find('\n') == std::string::npos && read_more()) {
  }
  const std::size_t end = output_.find('\n');
  std::string first = output_.substr(0, end);
  output_.erase(0, end == std::string::npos ? end : end + 1);
  return first;
}

void ChildProcess::read_rest() {
  while (read_more()) {
  }
  std::array<char, 4096> chunk;
  for (ssize_t got; (got = ::read(err_, chunk.data(), chunk.size())) > 0;) {
    errors_.append(chunk.data(), static_cast<std::size_t>(got));
  }
}

int ChildProcess::end(int signal_number) {
  ::kill(pid_, signal_number);
  return wait();
}

int ChildProcess::wait() {
  read_rest();
  int status = 0;
  ::waitpid(pid_, &status, 0);
  pid_ = 0;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace cellmirror::test
