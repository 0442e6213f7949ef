// Objects that are created repeatedly and read by other threads: when the last reader releases one, it is reused
// with the memory that it holds.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace cellmirror::app {

// Not for the tick. The objects may outlive the recycler.
template <class T>
class ObjectPool {
 public:
  static constexpr std::size_t kKept = 8;  // of those that nobody reads

  // With whatever it held when it was let go.
  [[nodiscard]] std::shared_ptr<T> take() {
    std::unique_ptr<T> object = free_list_->take();
    if (!object) object = std::make_unique<T>();
    return std::shared_ptr<T>(object.release(),
                              [free_list = free_list_](T* used) { free_list->put(std::unique_ptr<T>(used)); });
  }

 private:
  class FreeList {
   public:
    std::unique_ptr<T> take() {
      const std::scoped_lock lock(mutex_);
      if (free_.empty()) return nullptr;
      std::unique_ptr<T> object = std::move(free_.back());
      free_.pop_back();
      return object;
    }
    // In a deleter: must not throw, and does not, since the room is there from the start.
    void put(std::unique_ptr<T> object) noexcept {
      const std::scoped_lock lock(mutex_);
      if (free_.size() < kKept) free_.push_back(std::move(object));
    }

   private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<T>> free_ = [] {
      std::vector<std::unique_ptr<T>> room;
      room.reserve(kKept);
      return room;
    }();
  };

  std::shared_ptr<FreeList> free_list_ = std::make_shared<FreeList>();
};

}  // namespace cellmirror::app
