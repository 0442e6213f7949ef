// Starts programs of cellmirror that confine themselves. Any thread except the loop.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "rt_core/base/descriptor.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror {

// A process that was started here; ended and collected at the latest when this goes.
class ChildProcess {
 public:
  explicit ChildProcess(pid_t id) : id_(id) {}
  ~ChildProcess() { end(); }
  ChildProcess(ChildProcess&& other) noexcept : id_(std::exchange(other.id_, -1)) {}
  ChildProcess& operator=(ChildProcess&& other) noexcept;

  [[nodiscard]] pid_t id() const { return id_; }
  // Its status as waitpid() gives it; none if another call has collected it. A process that is already ending keeps its
  // status: the kernel ignores signals to it.
  std::optional<int> end();
  // Status of a process that has ended by itself (and is collected now) or that a signal has stopped. Does not block.
  std::optional<int> changed();

 private:
  pid_t id_;
};

struct StartedReader {
  ChildProcess child;
  Descriptor socket;  // ours; closing it is the end of the child's input
};

// Starts a reader of one file, with a socket as its standard input and output. It inherits neither signal settings nor
// priority nor other descriptors. The text of an error is part of a sentence.
[[nodiscard]] Result<StartedReader> start_reader(const std::filesystem::path& program);

// Starts a program with `socket` and `memory` as the descriptors of a channel (ipc/sandbox/channel.hpp). `subject` is
// its only argument, so that lists of processes show it.
[[nodiscard]] Result<ChildProcess> start_on_channel(const std::filesystem::path& program, const std::string& subject,
                                                    const Descriptor& socket, const Descriptor& memory);

// "6 (SIGABRT)".
[[nodiscard]] std::string signal_text(int signal);

// Fails with the reason if the program could not be started; does not start it.
[[nodiscard]] Result<void> check_program(const std::filesystem::path& program);

// Path of a program: in ../libexec/cellmirror/, seen from the folder of the running program, if it is installed there;
// else in that folder, as in a build.
[[nodiscard]] std::filesystem::path program_beside_this(std::string_view name);

}  // namespace cellmirror
