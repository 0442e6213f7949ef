// A lock that ends with its process, however that ends.
#pragma once

#include <sys/types.h>

#include <expected>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "rt_core/base/descriptor.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror {

struct LockHolder {
  pid_t pid = 0;
  std::string note;  // one word about the holder, e.g. its instance
};

// A file under flock(2). The kernel releases it when the last descriptor closes, also by kill -9; a file that is left
// behind is therefore no lock. Moved, not copied.
class LockFile {
 public:
  enum class Refusal { held, failed };
  struct Refused {
    Refusal why = Refusal::failed;
    LockHolder holder;  // of `held`; pid 0 where it could not be read
    Error error;
  };

  // Takes the lock and writes this process and `note` into the file. Does not wait, except while another process checks
  // the lock. Links are refused.
  static std::expected<LockFile, Refused> take(const std::filesystem::path& path, std::string_view note);

  LockFile() = default;
  LockFile(LockFile&& other) noexcept = default;
  LockFile& operator=(LockFile&& other) noexcept;
  ~LockFile();  // removes the file, then releases the lock

  [[nodiscard]] bool held() const { return file_.valid(); }
  // Whether the file at the path is still the locked one: logind empties a user's runtime folder at log-out.
  [[nodiscard]] bool in_place() const;
  void release();

 private:
  LockFile(Descriptor file, std::filesystem::path path) : file_(std::move(file)), path_(std::move(path)) {}
  Descriptor file_;
  std::filesystem::path path_;
};

// The holder of the lock at `path`, if any.
[[nodiscard]] std::optional<LockHolder> lock_holder(const std::filesystem::path& path);

}  // namespace cellmirror
