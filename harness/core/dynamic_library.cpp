#include "harness/core/dynamic_library.hpp"

#include <dlfcn.h>

namespace attest {

Result<DynamicLibrary> DynamicLibrary::open(const std::string& path) {
  void* const opened = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (opened) return DynamicLibrary({opened, [](void* handle) { ::dlclose(handle); }});
  const char* const text = ::dlerror();
  return fail(text ? text : "unknown error");
}

void* DynamicLibrary::find(const char* symbol) const { return ::dlsym(handle_.get(), symbol); }

}  // namespace attest
