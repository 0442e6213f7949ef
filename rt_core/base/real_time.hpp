// The mark of tick functions.
#pragma once

// A function that bears CELL_RT may run in the tick: it is noexcept, takes no heap memory, waits for no lock, formats
// no text, looks up no string and makes no system call but the clock. The mark is the only statement of that contract;
// tests run such functions under the allocation guard, and clang checks the attribute where it knows it.
#if defined(__clang__) && __has_cpp_attribute(clang::nonblocking)
#define CELL_RT noexcept [[clang::nonblocking]]
#else
#define CELL_RT noexcept
#endif
