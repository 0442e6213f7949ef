#include "ipc/runtime/system_error.hpp"

#include <system_error>

namespace cellmirror {

std::string system_error_text(int error_number) { return std::generic_category().message(error_number); }

}  // namespace cellmirror
