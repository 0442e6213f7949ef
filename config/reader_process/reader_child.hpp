// Starts a program of ours that reads files for the gateway, with a socket as its standard input and output. Any thread
// but the loop's.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>

#include "rt_core/base/descriptor.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror {

// A process that was started here; ended and collected at the latest when this goes.
class ReaderChild {
 public:
  explicit ReaderChild(pid_t id) : id_(id) {}
  ~ReaderChild() { end(); }
  ReaderChild(ReaderChild&& other) noexcept : id_(std::exchange(other.id_, -1)) {}
  ReaderChild& operator=(ReaderChild&& other) noexcept;

  // Its status as waitpid() gives it; none if another call has collected it. A process that is already ending keeps its
  // status: the kernel ignores signals to it.
  std::optional<int> end();

 private:
  pid_t id_;
};

struct StartedReader {
  ReaderChild child;
  Descriptor socket;  // ours; closing it is the end of the child's input
};

// Its signals, priority and descriptors are not those of this process. An error is part of a sentence.
[[nodiscard]] Result<StartedReader> start_reader(const std::filesystem::path& program);

// Why it could not be started, without starting it.
[[nodiscard]] Result<void> check_reader_program(const std::filesystem::path& program);

// Where it is installed: ../libexec/cellmirror/ as seen from the folder of the running program; else that folder
// itself, where ours are built.
[[nodiscard]] std::filesystem::path program_beside_this(std::string_view name);

}  // namespace cellmirror
