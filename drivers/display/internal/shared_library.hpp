// A library that is opened while the program runs. Private to this folder.
#pragma once

#include <dlfcn.h>

#include <initializer_list>

namespace cellmirror::display {

class SharedLibrary {
 public:
  // The first of `names` that there is.
  explicit SharedLibrary(std::initializer_list<const char*> names) {
    for (const char* name : names) {
      if (handle_ == nullptr) handle_ = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    }
  }
  [[nodiscard]] bool open() const { return handle_ != nullptr; }

  template <class Function>
  [[nodiscard]] bool find(Function*& function, const char* name) const {
    function = handle_ == nullptr ? nullptr : reinterpret_cast<Function*>(dlsym(handle_, name));
    return function != nullptr;
  }

 private:
  void* handle_ = nullptr;  // never closed: see GlContext
};

}  // namespace cellmirror::display
