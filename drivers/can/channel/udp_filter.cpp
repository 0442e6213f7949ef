#include "drivers/can/channel/udp_filter.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/ip.h>
#include <netinet/ip6.h>
#include <netinet/udp.h>

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace cellmirror::can {

// Offsets are those of the headers of UDP, IPv4 and IPv6.
std::vector<sock_filter> filter_without(const sockaddr_storage& sender) {
  struct Word {
    std::uint32_t offset;
    std::uint32_t value;  // as the filter loads it: in the order of the host
  };
  std::vector<Word> words;
  std::uint16_t port = 0;
  const auto network = [](std::size_t offset) {
    return static_cast<std::uint32_t>(SKF_NET_OFF) + static_cast<std::uint32_t>(offset);
  };
  if (sender.ss_family == AF_INET) {
    sockaddr_in v4{};
    std::memcpy(&v4, &sender, sizeof v4);
    port = ntohs(v4.sin_port);
    words.push_back({network(offsetof(iphdr, saddr)), ntohl(v4.sin_addr.s_addr)});
  } else {
    sockaddr_in6 v6{};
    std::memcpy(&v6, &sender, sizeof v6);
    port = ntohs(v6.sin6_port);
    for (std::size_t i = 0; i < 4; ++i) {
      std::uint32_t word = 0;
      std::memcpy(&word, &v6.sin6_addr.s6_addr[4 * i], sizeof word);
      words.push_back({network(offsetof(ip6_hdr, ip6_src) + 4 * i), ntohl(word)});
    }
  }
  constexpr std::uint32_t kWhole = 0xFFFF'FFFF;
  std::vector<sock_filter> program{BPF_STMT(BPF_LD | BPF_H | BPF_ABS, offsetof(udphdr, source))};
  // Behind each comparison: two instructions for each word to come, and the one that drops.
  const auto otherwise_take = [&](std::size_t left) { return static_cast<std::uint8_t>(2 * left + 1); };
  program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, port, 0, otherwise_take(words.size())));
  for (std::size_t i = 0; i < words.size(); ++i) {
    program.push_back(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, words[i].offset));
    program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, words[i].value, 0, otherwise_take(words.size() - i - 1)));
  }
  program.push_back(BPF_STMT(BPF_RET | BPF_K, 0));
  program.push_back(BPF_STMT(BPF_RET | BPF_K, kWhole));
  return program;
}

}  // namespace cellmirror::can
