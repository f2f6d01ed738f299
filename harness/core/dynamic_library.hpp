// A library that is loaded while the program runs.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "harness/core/result.hpp"

namespace attest {

class DynamicLibrary {
 public:
  // A path, or a name without a slash that the system searches in its folders of libraries. All
  // symbols are resolved here, not in the middle of a call. Errors: the text of the loader.
  static Result<DynamicLibrary> open(const std::string& path);

  // The address of an exported symbol; null if there is none.
  void* find(const char* symbol) const;

  // Stores the address in `function`. False if there is no such symbol.
  template <typename Function>
  bool find(const char* symbol, Function*& function) const {
    function = reinterpret_cast<Function*>(find(symbol));
    return function != nullptr;
  }

  // Keeps the library loaded.
  std::shared_ptr<void> handle() const { return handle_; }

 private:
  explicit DynamicLibrary(std::shared_ptr<void> handle) : handle_(std::move(handle)) {}

  std::shared_ptr<void> handle_;
};

}  // namespace attest
