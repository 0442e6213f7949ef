#include "own_network.hpp"

#include <net/if.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>

namespace cellmirror::dds::test {

namespace {
bool own = false;

bool bring_loopback_up() {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return false;
  ifreq request{};
  std::strncpy(request.ifr_name, "lo", IFNAMSIZ - 1);
  bool ok = ioctl(fd, SIOCGIFFLAGS, &request) == 0;
  request.ifr_flags = static_cast<short>(request.ifr_flags | IFF_UP);
  ok = ok && ioctl(fd, SIOCSIFFLAGS, &request) == 0;
  close(fd);
  return ok;
}
}  // namespace

bool enter_own_network() {
  own = unshare(CLONE_NEWNET) == 0 && bring_loopback_up();
  return own;
}

bool in_own_network() { return own; }

int test_domain(int index) { return own ? index : 40 + 8 * static_cast<int>(getpid() % 20) + index; }

}  // namespace cellmirror::dds::test
