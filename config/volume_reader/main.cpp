// cellmirror-volume-reader: requests from the socket at descriptor 0, an answer to each at 1, until the input ends.
#include <gdcmTrace.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <exception>
#include <new>
#include <string>
#include <string_view>

#include "config/volume_message/slice_message.hpp"
#include "config/volume_reader/slice_head.hpp"
#include "config/volume_reader/slice_pixels.hpp"
#include "ipc/sandbox/confinement.hpp"
#include "rt_core/base/text.hpp"

// With AddressSanitizer, which does not work with an address limit: the largest permitted allocation.
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() { return "max_allocation_size_mb=1024:detect_leaks=0"; }

namespace cellmirror {
namespace {

// False at the end of the input.
bool read_all(char* to, std::size_t size) {
  while (size > 0) {
    const ssize_t count = read(STDIN_FILENO, to, size);
    if (count == 0 || (count < 0 && errno != EINTR)) return false;
    if (count < 0) continue;
    to += count;
    size -= static_cast<std::size_t>(count);
  }
  return true;
}

bool write_all(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = write(STDOUT_FILENO, bytes.data(), bytes.size());
    if (count > 0) bytes.remove_prefix(static_cast<std::size_t>(count));
    if (count < 0 && errno != EINTR) return false;
  }
  return true;
}

template <class T>
std::string_view bytes_of(const T& value) {
  return {reinterpret_cast<const char*>(&value), sizeof(T)};
}

bool answer(SliceAnswerKind kind, std::string_view head, std::string_view rest = {}) {
  const SliceFrame frame{static_cast<std::uint32_t>(kind), 0, head.size() + rest.size()};
  return write_all(bytes_of(frame)) && write_all(head) && write_all(rest);
}

bool answer_one(SliceRequestKind kind, std::string_view bytes) {
  if (kind != SliceRequestKind::pixels) {
    const SliceHeadAnswer read = read_slice_head(bytes, kind == SliceRequestKind::head_of_all);
    return answer(read.kind, read.kind == SliceAnswerKind::head ? encode_slice_head(read.head) : std::string());
  }
  const Result<SlicePixels> pixels = read_slice_pixels(bytes);
  if (!pixels) return answer(SliceAnswerKind::error, encode_slice_error(pixels.error()));
  return answer(SliceAnswerKind::pixels, bytes_of(pixels->head), {pixels->values.data(), pixels->values.size()});
}

bool answer_safely(SliceRequestKind kind, std::string_view bytes) {
  Error why;
  try {
    return answer_one(kind, bytes);
  } catch (const std::bad_alloc&) {
    why = {"its reader ran out of memory", "export it again without compression"};
  } catch (const std::exception& exception) {
    why = {printable(exception.what()), {}};
  } catch (...) {
    why = {"it cannot be read", {}};
  }
  if (why.what.empty()) why.what = "it cannot be read";
  return answer(SliceAnswerKind::error, encode_slice_error(why));
}

int run() {
  // A slice of the largest size takes 32 MiB; its decoders hold it several times. Processor time for the largest
  // series.
  constexpr std::uint64_t kAddressSpace = std::uint64_t{1} << 30U;
  constexpr std::uint64_t kProcessorSeconds = 600;
  confine_this_process({kAddressSpace, kProcessorSeconds});
  gdcm::Trace::WarningOff();
  gdcm::Trace::ErrorOff();
  std::string bytes;
  while (true) {
    SliceFrame frame;
    if (!read_all(reinterpret_cast<char*>(&frame), sizeof(frame))) return 0;
    if (frame.kind < 1 || frame.kind > 3 || frame.bytes > kLargestSliceFile) return 1;
    bytes.resize(frame.bytes);
    if (!read_all(bytes.data(), bytes.size())) return 1;
    if (!answer_safely(static_cast<SliceRequestKind>(frame.kind), bytes)) return 1;
  }
}

}  // namespace
}  // namespace cellmirror

// Nothing of what a library would do at the end is worth doing.
int main() { _exit(cellmirror::run()); }
