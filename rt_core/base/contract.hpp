// Contracts of our own code: breaking one is a bug here, never bad input, and stops the program with its place.
#pragma once

#include <cstdio>
#include <cstdlib>

namespace cellmirror {

[[noreturn, gnu::cold, gnu::noinline]] inline void contract_broken(const char* condition, const char* file, int line) {
  std::fprintf(stderr, "cellmirror: contract broken: %s at %s:%d; this is a bug, please report it\n", condition, file,
               line);
  std::abort();
}

}  // namespace cellmirror

#define CELLMIRROR_EXPECTS(condition) \
  ((condition) ? static_cast<void>(0) : ::cellmirror::contract_broken(#condition, __FILE__, __LINE__))
