// Domains and addresses that the user gives, checked before the DDS library sees them.
#pragma once

#include <string>

#include "rt_core/base/result.hpp"

namespace cellmirror::dds {

[[nodiscard]] Result<void> check_domain(int domain);
// Fails where it is not an IPv4 address of this machine.
[[nodiscard]] Result<void> check_address(const std::string& address);

}  // namespace cellmirror::dds
