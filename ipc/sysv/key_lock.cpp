#include "ipc/sysv/key_lock.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <string_view>
#include <utility>

#include "ipc/runtime/runtime_folder.hpp"

namespace cellmirror {
namespace {

// Keys are per IPC namespace, lock files are not: the namespace is part of the file's name. /proc/thread-self since
// unshare(2) moves a thread.
std::string namespace_number() {
  std::array<char, 64> link{};
  const ssize_t length = ::readlink("/proc/thread-self/ns/ipc", link.data(), link.size());
  std::string digits;
  for (ssize_t i = 0; i < length; ++i) {
    const char c = link[static_cast<std::size_t>(i)];
    if (c >= '0' && c <= '9') digits += c;
  }
  return digits.empty() ? "0" : digits;
}

std::filesystem::path lock_path(const std::filesystem::path& runtime, std::int32_t key) {
  // A dot cannot occur in an instance's name, so this folder meets none of theirs.
  return runtime / ".locks" / fmt::format("key-{:#x}-ipc-{}", static_cast<std::uint32_t>(key), namespace_number());
}

Result<LockFile> take_file(std::int32_t key, const std::string& instance) {
  const auto runtime = runtime_folder();
  if (!runtime) return std::unexpected(runtime.error());
  const auto path = lock_path(*runtime, key);
  if (const auto made = make_private_folder(path.parent_path()); !made) return std::unexpected(made.error());
  auto file = LockFile::take(path, instance);
  if (file) return std::move(*file);
  const LockFile::Refused& refused = file.error();
  if (refused.why == LockFile::Refusal::failed) return std::unexpected(refused.error);
  return fail(fmt::format("the key {} is in use by process {}, the gateway of the instance {}", key_text(key),
                          refused.holder.pid, refused.holder.note.empty() ? "?" : refused.holder.note),
              "end that gateway, or start this one with --instance NAME and keys of its own");
}

}  // namespace

std::string key_text(std::int32_t key) { return fmt::format("{:#x} ({})", static_cast<std::uint32_t>(key), key); }

Result<KeyLock> KeyLock::take(std::int32_t key, const std::string& instance) {
  if (key == 0) {
    return fail("key 0 means a private queue, which no other process can find", "set another key in the cell file");
  }
  auto file = take_file(key, instance);
  if (!file) return std::unexpected(file.error());
  auto semaphore = KeySemaphore::take(key);
  if (!semaphore) return std::unexpected(semaphore.error());
  return KeyLock(std::move(*file), std::move(*semaphore), key, instance);
}

Result<void> KeyLock::confirm() {
  if (!file_.in_place()) {
    auto file = take_file(key_, instance_);
    if (!file) return std::unexpected(file.error());
    file_ = std::move(*file);
  }
  if (!semaphore_.in_place()) {
    auto semaphore = KeySemaphore::take(key_);
    if (!semaphore) return std::unexpected(semaphore.error());
    semaphore_ = std::move(*semaphore);
  }
  return {};
}

bool KeyLock::is_held(std::int32_t key) {
  if (KeySemaphore::is_held(key)) return true;
  const auto runtime = runtime_folder_for_client();
  return runtime && lock_holder(lock_path(*runtime, key)).has_value();
}

}  // namespace cellmirror
