// A program that a test runs.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace cellmirror::test {

class ChildProcess {
 public:
  explicit ChildProcess(std::vector<std::string> command);
  ~ChildProcess();  // ends it if it still runs, by SIGTERM first
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  [[nodiscard]] pid_t pid() const { return pid_; }
  // The next line of its standard output, without the line break; empty at its end.
  std::string line();
  // Sends the signal, waits for the end, and returns the exit status; 128 + number where a signal ended it.
  int end(int signal_number);
  // Waits for the end, reading the rest of what it writes.
  int wait();
  [[nodiscard]] const std::string& output() const { return output_; }  // standard output, what line() has not taken
  [[nodiscard]] const std::string& errors() const { return errors_; }  // standard error, after wait()

 private:
  bool read_more();
  void read_rest();
  pid_t pid_ = 0;
  int out_ = -1;
  int err_ = -1;
  std::string output_;
  std::string errors_;
};

}  // namespace cellmirror::test
