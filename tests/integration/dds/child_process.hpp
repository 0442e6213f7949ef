// A helper program of the tests, ended with the test.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace cellmirror::dds::test {

class ChildProcess {
 public:
  // `program`: a name beside the running test program.
  ChildProcess(const std::string& program, std::vector<std::string> arguments);
  ~ChildProcess();  // SIGKILL, if it still runs
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  void signal(int number) const;
  void kill_and_wait();
  // Lines of its standard output so far; does not wait.
  [[nodiscard]] int lines();

 private:
  pid_t pid_ = -1;
  int output_ = -1;
  int lines_ = 0;
};

}  // namespace cellmirror::dds::test
