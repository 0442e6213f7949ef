#include "ipc/sysv/shared_segment.hpp"

#include <fmt/format.h>
#include <sys/ipc.h>
#include <sys/shm.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "ipc/runtime/ipc_owner.hpp"
#include "ipc/runtime/system_error.hpp"
#include "ipc/wire/shared_words.hpp"
#include "rt_core/base/log.hpp"

namespace cellmirror {
namespace {

std::string segment_text(const std::string& purpose, std::int32_t key) {
  return fmt::format("the shared memory {}{}{}", purpose, purpose.empty() ? "" : " ", key_text(key));
}

std::string segment_text(const SharedSegment::Options& options) { return segment_text(options.purpose, options.key); }

std::size_t page_bytes() { return static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)); }

std::size_t whole_pages(std::size_t bytes) { return (bytes + page_bytes() - 1) / page_bytes() * page_bytes(); }

// errno of a removed segment: EIDRM while a process is attached, EINVAL once its number is unknown.
bool tells_removed(int error_number) { return error_number == EIDRM || error_number == EINVAL; }

struct Found {
  int id = -1;
  std::size_t segment_bytes = 0;
  bool new_one = false;
};

std::unexpected<Error> segment_of_other(const SharedSegment::Options& options) {
  const auto found = ipc_owner(IpcKind::memory, options.key);
  const std::string owner = found ? user_text(found->creator) : "another user";
  const std::string changed =
      found && found->owner != found->creator ? fmt::format(", and belongs to {} now", user_text(found->owner)) : "";
  const std::string command =
      found ? remove_command(IpcKind::memory, found->id) : fmt::format("ipcrm -M {}", options.key);
  return fail(fmt::format("{} was created by another user: {}{}", segment_text(options), owner, changed),
              fmt::format("that user or root must run {}, or set another key in the cell file", command));
}

std::unexpected<Error> in_use(const SharedSegment::Options& options, const shmid_ds& found, const std::string& why) {
  return fail(fmt::format("{} exists already and {}", segment_text(options), why),
              fmt::format("end the programs that use it (the last one was process {}, it was created by process {}) "
                          "and run ipcrm -M {:#x}, or set another key in the cell file",
                          found.shm_lpid, found.shm_cpid, static_cast<std::uint32_t>(options.key)));
}

// Whether the existing segment belongs to this user and has no wider mode.
Result<void> check_owner(const SharedSegment::Options& options, const shmid_ds& found) {
  if (found.shm_perm.uid != ::geteuid() || found.shm_perm.cuid != ::geteuid()) {
    return segment_of_other(options);
  }
  const unsigned mode = found.shm_perm.mode & 0777u;
  if ((mode & ~options.mode) != 0) {
    return fail(fmt::format("{} has a wider mode ({:o}) than the cell file allows ({:o})", segment_text(options), mode,
                            options.mode),
                fmt::format("run ipcrm -M {:#x}, create it with the mode {:o}, or allow that mode in the cell file",
                            static_cast<std::uint32_t>(options.key), options.mode));
  }
  return {};
}

enum class Fit { yes, remove_it };

// `mapped`: the bytes that have to be mapped exactly, 0 where it is the segment's to say.
Result<Fit> check_size(const SharedSegment::Options& options, const shmid_ds& found, std::size_t mapped) {
  const bool unused = found.shm_nattch == 0;
  if (found.shm_segsz > kMaxSegmentBytes) {
    return in_use(options, found,
                  fmt::format("has {} bytes, so it has another purpose", std::uint64_t{found.shm_segsz}));
  }
  if (found.shm_segsz < options.bytes) {
    if (unused) return Fit::remove_it;
    return in_use(options, found,
                  fmt::format("has {} bytes, but {} are needed", std::uint64_t{found.shm_segsz}, options.bytes));
  }
  if (mapped != 0 && whole_pages(found.shm_segsz) != mapped) {
    if (unused) return Fit::remove_it;
    return in_use(options, found, "has changed its size");
  }
  return Fit::yes;
}

std::unexpected<Error> cannot_make(const SharedSegment::Options& options, int reason) {
  std::string remedy;
  if (reason == ENOSPC)
    remedy = "remove unused segments (ipcs -m, ipcrm -m ID) or raise kernel.shmmni and kernel.shmall";
  if (reason == EINVAL) remedy = fmt::format("sysctl -w kernel.shmmax={}", kMaxSegmentBytes);
  return fail(fmt::format("cannot create {}: {}", segment_text(options), system_error_text(reason)), remedy);
}

// Makes the segment, or finds the one that may be taken. A few tries: others may make or remove it at the same time.
Result<Found> find_or_make(const SharedSegment::Options& options, std::size_t mapped) {
  for (int i = 0; i < 8; ++i) {
    const int made = ::shmget(options.key, options.bytes, IPC_CREAT | IPC_EXCL | static_cast<int>(options.mode));
    if (made >= 0) return Found{made, options.bytes, true};
    if (errno != EEXIST) return cannot_make(options, errno);
    const int id = ::shmget(options.key, 0, 0);
    if (id < 0) {
      if (errno == ENOENT) continue;
      return segment_of_other(options);
    }
    shmid_ds found{};
    if (::shmctl(id, IPC_STAT, &found) != 0) {
      if (tells_removed(errno)) continue;
      return segment_of_other(options);
    }
    if (const auto ours = check_owner(options, found); !ours) return std::unexpected(ours.error());
    const auto fit = check_size(options, found, mapped);
    if (!fit) return std::unexpected(fit.error());
    if (*fit == Fit::yes) return Found{id, found.shm_segsz, false};
    ::shmctl(id, IPC_RMID, nullptr);
  }
  return fail(fmt::format("{} is repeatedly removed by another program", segment_text(options)),
              "end that program, or set another key in the cell file");
}

// Takes every page into this process's page table, writable, and changes nothing.
void touch_pages(std::byte* memory, std::size_t bytes) {
  const std::span<std::byte> pages(memory, whole_pages(bytes));
  for (std::size_t at = 0; at < pages.size(); at += page_bytes()) shared_words::touch(pages, at);
}

void touch_pages_read_only(const std::byte* memory, std::size_t bytes) {
  for (std::size_t at = 0; at < bytes; at += page_bytes()) {
    static_cast<void>(*static_cast<const volatile std::byte*>(memory + at));
  }
}

bool attach_failed(const void* address) { return address == reinterpret_cast<void*>(-1); }

void watch(const SharedSegment::Options& options, int id) {
  if (options.guard == nullptr || options.block == GuardedBlock::none) return;
  if (!options.guard->watch(id, options.block))
    log_warning("shared-memory", "{} is not guarded: too many are", segment_text(options));
}

void forget(const SharedSegment::Options& options, int id) {
  if (options.guard != nullptr) options.guard->forget(id);
}

bool is_removed(int id, shmid_ds& found) {
  if (::shmctl(id, IPC_STAT, &found) != 0) return true;
  return (found.shm_perm.mode & SHM_DEST) != 0;
}

}  // namespace

struct SharedSegment::State {
  Options options;
  KeyLock lock;
  int id = -1;
  std::byte* address = nullptr;
  std::size_t mapped = 0;  // whole pages
  bool taken_over = false;
  std::uint64_t renewed = 0;
};

namespace {

struct Mapping {
  int id = -1;
  std::byte* address = nullptr;
  std::size_t mapped = 0;
  bool taken_over = false;
};

// `address`: where it has to be, over what is mapped there; null: anywhere.
Result<Mapping> map_segment(const SharedSegment::Options& options, std::byte* address, std::size_t mapped) {
  for (int i = 0; i < 8; ++i) {
    const auto found = find_or_make(options, mapped);
    if (!found) return std::unexpected(found.error());
    void* got = ::shmat(found->id, address, address == nullptr ? 0 : SHM_REMAP);
    if (attach_failed(got)) {
      const int reason = errno;
      if (tells_removed(reason)) continue;
      if (found->new_one) ::shmctl(found->id, IPC_RMID, nullptr);
      return fail(fmt::format("cannot attach {}: {}", segment_text(options), system_error_text(reason)),
                  reason == ENOMEM ? "raise the limit of locked memory (cellmirror doctor)" : "");
    }
    Mapping mapping{found->id, static_cast<std::byte*>(got), whole_pages(found->segment_bytes), false};
    shmid_ds now{};
    if (is_removed(mapping.id, now)) {  // between the two calls
      if (address == nullptr) ::shmdt(got);
      continue;
    }
    mapping.taken_over = now.shm_nattch > 1;
    if (!found->new_one && !mapping.taken_over) std::fill_n(mapping.address, found->segment_bytes, std::byte{0});
    if ((now.shm_perm.mode & 0777u) != options.mode) {
      now.shm_perm.mode = static_cast<decltype(now.shm_perm.mode)>(options.mode);
      ::shmctl(mapping.id, IPC_SET, &now);
    }
    touch_pages(mapping.address, mapping.mapped);
    return mapping;
  }
  return fail(fmt::format("{} is repeatedly removed by another program", segment_text(options)),
              "end that program, or set another key in the cell file");
}

}  // namespace

Result<std::unique_ptr<SharedSegment>> SharedSegment::make(Options options) {
  if (options.bytes == 0 || options.bytes > kMaxSegmentBytes) {
    return fail(fmt::format("{} cannot have a size of {} bytes", segment_text(options), options.bytes),
                fmt::format("set a size from 1 to {}", kMaxSegmentBytes));
  }
  auto lock = KeyLock::take(options.key, options.instance);
  if (!lock) return std::unexpected(lock.error());
  const auto mapping = map_segment(options, nullptr, 0);
  if (!mapping) return std::unexpected(mapping.error());
  watch(options, mapping->id);
  auto state = std::make_unique<State>(State{.options = std::move(options),
                                             .lock = std::move(*lock),
                                             .id = mapping->id,
                                             .address = mapping->address,
                                             .mapped = mapping->mapped,
                                             .taken_over = mapping->taken_over});
  return std::unique_ptr<SharedSegment>(new SharedSegment(std::move(state)));
}

SharedSegment::SharedSegment(std::unique_ptr<State> state) : state_(std::move(state)) {}

SharedSegment::~SharedSegment() {
  forget(state_->options, state_->id);
  // By number, not by key: one created by another process meanwhile is not touched.
  ::shmctl(state_->id, IPC_RMID, nullptr);
  ::shmdt(state_->address);
}

std::span<std::byte> SharedSegment::memory() const { return {state_->address, state_->options.bytes}; }
const SharedSegment::Options& SharedSegment::options() const { return state_->options; }
bool SharedSegment::taken_over() const { return state_->taken_over; }
std::uint64_t SharedSegment::renewed() const { return state_->renewed; }

SegmentUsers SharedSegment::users() const {
  shmid_ds found{};
  SegmentUsers users;
  users.gone = is_removed(state_->id, found);
  users.attached = found.shm_nattch;
  users.last_process = found.shm_lpid;
  return users;
}

Result<void> SharedSegment::renew() {
  if (!users().gone) return {};
  if (const auto confirmed = state_->lock.confirm(); !confirmed) return confirmed;
  const auto mapping = map_segment(state_->options, state_->address, state_->mapped);
  if (!mapping) return std::unexpected(mapping.error());
  forget(state_->options, state_->id);
  watch(state_->options, mapping->id);
  state_->id = mapping->id;
  state_->taken_over = mapping->taken_over;
  ++state_->renewed;
  return {};
}

Result<AttachedSegment> AttachedSegment::attach(std::int32_t key, std::size_t bytes, bool read_only) {
  const std::string name = segment_text("", key);
  const int id = ::shmget(key, 0, 0);
  if (id < 0) {
    if (errno == ENOENT) return fail(fmt::format("{} does not exist", name), "start the gateway, or use another key");
    return fail(fmt::format("cannot open {}: {}", name, system_error_text(errno)));
  }
  shmid_ds found{};
  if (::shmctl(id, IPC_STAT, &found) != 0) {
    return fail(fmt::format("cannot open {}: {}", name, system_error_text(errno)),
                "run this as the user of the gateway");
  }
  if (found.shm_perm.uid != ::geteuid()) {
    return fail(fmt::format("{} belongs to another user ({})", name, found.shm_perm.uid),
                "run this as the user of the gateway");
  }
  if (found.shm_segsz < bytes) {
    return fail(fmt::format("{} has {} bytes, but {} are needed", name, std::uint64_t{found.shm_segsz}, bytes),
                "set a larger size in the cell file");
  }
  void* address = ::shmat(id, nullptr, read_only ? SHM_RDONLY : 0);
  if (attach_failed(address)) {
    return fail(fmt::format("cannot attach {}: {}", name, system_error_text(errno)));
  }
  auto* memory = static_cast<std::byte*>(address);
  if (read_only) {
    touch_pages_read_only(memory, bytes);
  } else {
    touch_pages(memory, bytes);
  }
  return AttachedSegment({memory, bytes}, id);
}

AttachedSegment::~AttachedSegment() {
  if (!memory_.empty()) ::shmdt(memory_.data());
}

AttachedSegment::AttachedSegment(AttachedSegment&& other) noexcept
    : memory_(std::exchange(other.memory_, {})), id_(std::exchange(other.id_, -1)) {}

AttachedSegment& AttachedSegment::operator=(AttachedSegment&& other) noexcept {
  if (this != &other) {
    if (!memory_.empty()) ::shmdt(memory_.data());
    memory_ = std::exchange(other.memory_, {});
    id_ = std::exchange(other.id_, -1);
  }
  return *this;
}

bool AttachedSegment::removed() const {
  shmid_ds found{};
  return is_removed(id_, found);
}

}  // namespace cellmirror
