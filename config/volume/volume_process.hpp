// The process that reads DICOM slices, cellmirror-volume-reader: what a damaged file does there ends that process and
// nothing else. Blocks; one thread at a time.
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "config/volume_message/slice_message.hpp"
#include "ipc/sandbox/child_process.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror {

struct VolumeReader {
  std::filesystem::path program;
  std::chrono::milliseconds longest{std::chrono::seconds(30)};  // for an answer
};

// Beside the running program, where it is installed and where it is built.
[[nodiscard]] VolumeReader installed_volume_reader();

// What is in a file.
struct SliceHeadRead {
  SliceAnswerKind kind = SliceAnswerKind::no_dicom;  // head, no_dicom or incomplete
  SliceHead head;
};

// Answers are untrusted. Errors are parts of sentences about the file: "its reader ended with signal 11 (SIGSEGV): the
// file is damaged". After an error of the connection the process has ended, and the next request starts another one.
class VolumeProcess {
 public:
  explicit VolumeProcess(VolumeReader reader = installed_volume_reader()) : reader_(std::move(reader)) {}

  // `whole`: `bytes` is the whole file.
  [[nodiscard]] Result<SliceHeadRead> head(std::string_view bytes, bool whole);
  // The values of a slice of that size into `to`, which holds them in their type.
  [[nodiscard]] Result<void> pixels(std::string_view bytes, std::uint32_t columns, std::uint32_t rows, SliceValues type,
                                    std::span<std::byte> to);

 private:
  struct Answer {
    SliceAnswerKind kind = SliceAnswerKind::error;
    std::uint64_t bytes = 0;  // still to be received
  };

  Result<void> start();
  Result<Answer> ask(SliceRequestKind kind, std::string_view bytes);
  Result<void> send(std::string_view bytes);
  Result<void> receive(std::span<std::byte> to);
  Result<std::string> receive_text(std::uint64_t bytes, std::size_t most);
  std::unexpected<Error> ended(bool too_late);
  std::unexpected<Error> damaged_answer();

  VolumeReader reader_;
  std::optional<StartedReader> started_;
  std::chrono::steady_clock::time_point until_;
};

}  // namespace cellmirror
