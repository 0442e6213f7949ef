// Calls from other threads to the server's thread. May outlive the server: calls that come then are dropped.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <utility>
#include <vector>

#include "rt_core/base/descriptor.hpp"

namespace cellmirror::web {

class Connection;

struct Posted {
  std::uint64_t connection = 0;              // 0: for the server itself
  std::function<void(Connection*)> receive;  // null for the server itself; not called where the connection is gone
};

// Any thread.
class Inbox {
 public:
  explicit Inbox(Descriptor wake_up) : wake_up_(std::move(wake_up)) {}

  void post(std::uint64_t connection, std::function<void(Connection*)> receive);
  void wake();
  void close();
  [[nodiscard]] std::vector<Posted> take();
  [[nodiscard]] int fd() const { return wake_up_.get(); }

 private:
  Descriptor wake_up_;
  std::mutex mutex_;
  bool closed_ = false;
  std::vector<Posted> posted_;
};

}  // namespace cellmirror::web
