// Checks of domains and addresses from the cell file.
#pragma once

#include <string>

#include "rt_core/base/result.hpp"

namespace cellmirror::dds {

[[nodiscard]] Result<void> check_domain(int domain);
// Fails if it is not an IPv4 address of this machine.
[[nodiscard]] Result<void> check_address(const std::string& address);

}  // namespace cellmirror::dds
