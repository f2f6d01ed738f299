// A library that is loaded while the program runs.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "harness/core/result.hpp"

namespace attest {

class DynamicLibrary {
 public:
  // `path`: a path, or a name without a slash, which the loader searches in the system's folders.
  // Symbols are resolved here (RTLD_NOW), not at the first call of a function. Errors: dlerror().
  static Result<DynamicLibrary> open(const std::string& path);

  // The address of an exported symbol; null if there is none.
  void* find(const char* symbol) const;

  // Stores the address in `function`, or null if there is no such symbol. True if there is.
  template <typename Function>
  bool find(const char* symbol, Function*& function) const {
    function = reinterpret_cast<Function*>(find(symbol));
    return function != nullptr;
  }

  // The library stays loaded as long as a copy of this handle exists.
  std::shared_ptr<void> handle() const { return handle_; }

 private:
  explicit DynamicLibrary(std::shared_ptr<void> handle) : handle_(std::move(handle)) {}

  std::shared_ptr<void> handle_;
};

}  // namespace attest
