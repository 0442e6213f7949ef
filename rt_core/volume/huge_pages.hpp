// Large pages for what rays read from all over a volume: each page has its entry in the processor's cache of
// translations, and a volume of 256 MiB in pages of 4 KiB has 65,536 of them.
#pragma once

#include <cstddef>

namespace cellmirror::volume {

// Asks the system to put memory that is in use into large pages, now; copies it within the system. Any thread, not real
// time. Where the system refuses nothing changes.
void use_huge_pages(const void* begin, std::size_t bytes);

}  // namespace cellmirror::volume
