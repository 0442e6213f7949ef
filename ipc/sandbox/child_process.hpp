// Starts a program of ours that is confined. Any thread but the loop's.
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
  // Its status if it has ended by itself, which is collected, or if it was stopped by a signal. Does not wait.
  std::optional<int> changed();

 private:
  pid_t id_;
};

struct StartedReader {
  ChildProcess child;
  Descriptor socket;  // ours; closing it is the end of the child's input
};

// With a socket as its standard input and output. Its signals, priority and descriptors are not those of this process.
// An error is part of a sentence.
[[nodiscard]] Result<StartedReader> start_reader(const std::filesystem::path& program);

// With `socket` and `memory` as the descriptors of a channel (ipc/sandbox/channel.hpp), and `subject` as its argument,
// for people who look at lists of processes.
[[nodiscard]] Result<ChildProcess> start_on_channel(const std::filesystem::path& program, const std::string& subject,
                                                    const Descriptor& socket, const Descriptor& memory);

// Why it could not be started, without starting it.
[[nodiscard]] Result<void> check_reader_program(const std::filesystem::path& program);

// Where it is installed: ../libexec/cellmirror/ as seen from the folder of the running program; else that folder
// itself, where ours are built.
[[nodiscard]] std::filesystem::path program_beside_this(std::string_view name);

}  // namespace cellmirror
