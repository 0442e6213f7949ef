// A network of the test program's own, so that parallel tests and peers on the machine's loopback do not meet.
#pragma once

#include <string>

namespace cellmirror::dds::test {

// Moves the process into a network namespace with nothing but a bare `lo` (no multicast flag, no routes) and brings
// that up. Call before any thread starts. False where this machine does not permit it; the tests then run on the
// machine's own loopback, in a domain chosen by process id.
bool enter_own_network();
[[nodiscard]] bool in_own_network();

// A DDS domain for a test: different ones for different `index` (0..7) and, on a shared network, different processes.
[[nodiscard]] int test_domain(int index);

}  // namespace cellmirror::dds::test
