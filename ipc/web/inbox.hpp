// How other threads tell the server's thread something. Outlives the server where somebody still holds it: what comes
// then is forgotten.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <utility>
#include <vector>

#include "ipc/runtime/descriptor.hpp"

namespace cellmirror::web {

class Connection;

struct Posted {
  std::uint64_t connection = 0;              // 0: for the server itself
  std::function<void(Connection*)> receive;  // null for the server's own, and never called where the client is gone
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
