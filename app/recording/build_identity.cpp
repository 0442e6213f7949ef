#include "app/recording/build_identity.hpp"

#include <elf.h>
#include <fmt/format.h>
#include <link.h>

#include <cstddef>
#include <cstring>

namespace cellmirror::app {

namespace {

// Of one segment of notes.
std::string build_id_in(const std::byte* notes, std::size_t size) {
  while (size >= sizeof(ElfW(Nhdr))) {
    ElfW(Nhdr) head;
    std::memcpy(&head, notes, sizeof(head));
    const std::size_t name = (std::size_t{head.n_namesz} + 3U) & ~std::size_t{3};
    const std::size_t content = (std::size_t{head.n_descsz} + 3U) & ~std::size_t{3};
    if (sizeof(head) + name + content > size) return {};
    const std::byte* const text = notes + sizeof(head);
    if (head.n_type == NT_GNU_BUILD_ID && head.n_namesz == 4 && std::memcmp(text, "GNU", 4) == 0) {
      std::string out;
      for (std::size_t i = 0; i < head.n_descsz; ++i)
        out += fmt::format("{:02x}", static_cast<unsigned>(text[name + i]));
      return out;
    }
    notes += sizeof(head) + name + content;
    size -= sizeof(head) + name + content;
  }
  return {};
}

}  // namespace

std::string build_identity() {
  std::string out;
  dl_iterate_phdr(
      [](dl_phdr_info* info, std::size_t /*size*/, void* found) {
        for (int i = 0; i < info->dlpi_phnum; ++i) {
          const auto& segment = info->dlpi_phdr[i];
          if (segment.p_type != PT_NOTE) continue;
          const auto* const notes = reinterpret_cast<const std::byte*>(info->dlpi_addr + segment.p_vaddr);
          auto& id = *static_cast<std::string*>(found);
          if (id.empty()) id = build_id_in(notes, segment.p_memsz);
        }
        return 1;  // the first object is the program
      },
      &out);
  return out;
}

std::string_view compute_target() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0) return "avx2";
#endif
  return "baseline";
}

}  // namespace cellmirror::app
