#include <cstdio>

#include "app/subcommands/subcommand.hpp"

namespace cellmirror::app {

int refuse(const std::string& what) {
  std::fprintf(stderr, "cellmirror: %s\n", what.c_str());
  return kExitRefused;
}

}  // namespace cellmirror::app
