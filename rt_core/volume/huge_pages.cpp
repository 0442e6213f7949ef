#include "rt_core/volume/huge_pages.hpp"

#include <sys/mman.h>

#include <cstdint>

namespace cellmirror::volume {

namespace {

constexpr std::uintptr_t kHugePage = std::uintptr_t{2} << 20U;  // on x86-64, and on ARM with pages of 4 KiB
constexpr int kCollapse = 25;  // MADV_COLLAPSE of Linux 6.1, which glibc 2.36 does not name

}  // namespace

void use_huge_pages(const void* begin, std::size_t bytes) {
  const auto address = reinterpret_cast<std::uintptr_t>(begin);
  const std::uintptr_t first = (address + kHugePage - 1) / kHugePage * kHugePage;
  const std::uintptr_t end = (address + bytes) / kHugePage * kHugePage;
  if (first >= end) return;
  void* const whole = reinterpret_cast<void*>(first);  // NOLINT(performance-no-int-to-ptr): rounded to a page
  // Older systems then do it by and by.
  static_cast<void>(madvise(whole, end - first, MADV_HUGEPAGE));
  static_cast<void>(madvise(whole, end - first, kCollapse));
}

}  // namespace cellmirror::volume
