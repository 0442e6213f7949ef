// Several gateways side by side: each has a name, a folder while it runs, and System V keys of its own.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <expected>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/runtime/lock_file.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror {

inline constexpr std::string_view kDefaultInstance = "default";

// 1 to 32 of A-Z a-z 0-9 _ -
[[nodiscard]] Result<void> check_instance_name(std::string_view name);

// The keys of an instance whose cell file sets none: those of the manual for "default"; else three consecutive ones
// from 0x434D0000 + 3 * (FNV-1a(name) mod 21845), in the order script, sensor, reply.
[[nodiscard]] QueueConfig default_queues(std::string_view instance);
// The same for a cell file: a key that is still the manual's is replaced by the instance's own.
[[nodiscard]] QueueConfig queues_of_instance(std::string_view instance, QueueConfig from_cell);

// Data of a running gateway.
struct InstanceInfo {
  std::string name;
  pid_t pid = 0;
  std::string cell;  // the cell file
  QueueConfig queues;
};

// A gateway's claim on its name: the lock, the folder <runtime>/<name>/ and instance.json in it. Ends with the process;
// the destructor takes the files away.
class Instance {
 public:
  // Refused where a gateway of this name runs; the message names its process.
  static Result<Instance> claim(const InstanceInfo& info);

  Instance(Instance&&) noexcept = default;
  Instance& operator=(Instance&&) = delete;
  ~Instance();

  [[nodiscard]] const InstanceInfo& info() const { return info_; }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] std::filesystem::path control_socket() const { return folder_ / "control.sock"; }

 private:
  Instance(LockFile lock, InstanceInfo info, std::filesystem::path folder);
  LockFile lock_;
  InstanceInfo info_;
  std::filesystem::path folder_;
};

// "no gateway of the instance NAME is running", or who runs it where another user does and it may not be asked.
[[nodiscard]] std::unexpected<Error> not_running(std::string_view name);
// Of a running gateway; fails with "no gateway of the instance NAME is running; start one with ..." if there is none.
[[nodiscard]] Result<InstanceInfo> find_instance(std::string_view name);
// All that run, by name. What others left behind is taken away.
[[nodiscard]] Result<std::vector<InstanceInfo>> running_instances();
// Where a client finds the socket of an instance, whether it runs or not.
[[nodiscard]] Result<std::filesystem::path> control_socket_of(std::string_view instance);

}  // namespace cellmirror
