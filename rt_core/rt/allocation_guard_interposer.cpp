// The C library's heap functions, each with a check of the allocation guard before it. Linked into a program, these
// definitions come before the C library's own for the program and all its shared libraries ("Replacing malloc", glibc
// manual 3.2.5: a replacement has to define all of them).
#include "rt_core/rt/allocation_guard.hpp"

#ifdef CELLMIRROR_SANITIZED  // sanitizers bring interposers of their own, and call hooks from them

#include <sanitizer/allocator_interface.h>

#include <cstddef>

namespace {

using cellmirror::detail::heap_calls_of_thread;

void on_allocation(const volatile void* /*block*/, std::size_t /*size*/) {
  if (heap_calls_of_thread.depth > 0) cellmirror::detail::note_allocation_in_guard();
}

void on_free(const volatile void* block) {
  if (block != nullptr && heap_calls_of_thread.depth > 0) cellmirror::detail::note_free_in_guard();
}

[[gnu::constructor]] void arm() noexcept {
  if (__sanitizer_install_malloc_and_free_hooks(on_allocation, on_free) != 0) {
    cellmirror::detail::arm_allocation_guard();
  }
}

}  // namespace

#else

#include <unistd.h>

#include <cerrno>
#include <cstddef>

// The C library's implementations, exported under these names for replacements to use.
// NOLINTBEGIN(readability-identifier-naming)
extern "C" {
void* __libc_malloc(std::size_t size) noexcept;
void* __libc_calloc(std::size_t count, std::size_t size) noexcept;
void* __libc_realloc(void* block, std::size_t size) noexcept;
void __libc_free(void* block) noexcept;
void* __libc_memalign(std::size_t alignment, std::size_t size) noexcept;
}
// NOLINTEND(readability-identifier-naming)

namespace {

using cellmirror::detail::heap_calls_of_thread;

inline void look_at_allocation() noexcept {
  if (heap_calls_of_thread.depth > 0) [[unlikely]] {
    cellmirror::detail::note_allocation_in_guard();
  }
}

inline bool power_of_two(std::size_t value) noexcept { return value != 0 && (value & (value - 1)) == 0; }

[[gnu::constructor]] void arm() noexcept { cellmirror::detail::arm_allocation_guard(); }

}  // namespace

extern "C" {

void* malloc(std::size_t size) noexcept {
  look_at_allocation();
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) noexcept {
  look_at_allocation();
  return __libc_calloc(count, size);
}

void* realloc(void* block, std::size_t size) noexcept {
  look_at_allocation();
  return __libc_realloc(block, size);
}

void free(void* block) noexcept {
  if (block != nullptr && heap_calls_of_thread.depth > 0) [[unlikely]] {
    cellmirror::detail::note_free_in_guard();
  }
  __libc_free(block);
}

void* memalign(std::size_t alignment, std::size_t size) noexcept {
  look_at_allocation();
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  look_at_allocation();
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
  look_at_allocation();
  if (!power_of_two(alignment) || alignment % sizeof(void*) != 0) {
    return EINVAL;
  }
  const int saved = errno;  // POSIX: the error is returned, errno stays as it was
  void* memory = __libc_memalign(alignment, size);
  errno = saved;
  if (memory == nullptr) {
    return ENOMEM;
  }
  *block = memory;
  return 0;
}

void* valloc(std::size_t size) noexcept {
  look_at_allocation();
  return __libc_memalign(static_cast<std::size_t>(sysconf(_SC_PAGESIZE)), size);
}

void* pvalloc(std::size_t size) noexcept {
  look_at_allocation();
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const std::size_t rounded = (size + page - 1) / page * page;
  if (rounded < size) {
    errno = ENOMEM;
    return nullptr;
  }
  return __libc_memalign(page, rounded);
}

}  // extern "C"

#endif
