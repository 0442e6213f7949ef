// A setting of the process that is made before what uses it.
#pragma once

#include <mutex>

namespace cellmirror::dds {

// Any thread.
template <class Value>
class ProcessSetting {
 public:
  void set(const Value& value) {
    const std::scoped_lock lock(mutex_);
    value_ = value;
  }
  [[nodiscard]] Value get() {
    const std::scoped_lock lock(mutex_);
    return value_;
  }

 private:
  std::mutex mutex_;
  Value value_;
};

}  // namespace cellmirror::dds
