#include "harness/core/own_arena.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <cstring>

#include <fcntl.h>
#include <malloc.h>
#include <pthread.h>
#include <sys/mman.h>
#include <unistd.h>

namespace attest {
namespace {

// The usual stack of a main thread. The default for other threads depends on `ulimit -s`. A large
// limit gives a large stack, which counts in the limit of a port's memory. Without a limit the
// default is only 2 MiB.
constexpr std::size_t stack_bytes = std::size_t{8} << 20;

void* call(void* work) {
  (*static_cast<const std::function<void()>*>(work))();
  return nullptr;
}

struct Pages {
  char* begin = nullptr;
  std::size_t size = 0;
};

// The begin of the heap as /proc/self/maps has it. Allocates no memory, because that could change
// the heap.
char* begin_of_heap() {
  const int maps = ::open("/proc/self/maps", O_RDONLY | O_CLOEXEC);
  if (maps < 0) return nullptr;
  std::array<char, 4096> text{};  // the heap is among the first lines, after those of the program
  std::size_t size = 0;
  for (ssize_t got = 1; got > 0 && size + 1 < text.size(); size += static_cast<std::size_t>(got)) {
    got = std::max<ssize_t>(::read(maps, text.data() + size, text.size() - 1 - size), 0);
  }
  ::close(maps);
  const char* line = std::strstr(text.data(), "[heap]");
  while (line != nullptr && line > text.data() && line[-1] != '\n') --line;
  unsigned long begin = 0, end = 0;
  if (line == nullptr || std::sscanf(line, "%lx-%lx rw-p", &begin, &end) != 2) return nullptr;
  return reinterpret_cast<char*>(begin);
}

// Also when make_heap_cheap_to_fork() was called before: the system then no longer calls the pages
// of that time a heap.
Pages pages_of_heap() {
  static char* const begin = begin_of_heap();
  if (begin == nullptr) return {};
  return {begin, static_cast<std::size_t>(static_cast<char*>(::sbrk(0)) - begin)};
}

// A file in memory with these bytes, which cannot be changed any more. -1: no memory.
int sealed_copy(const Pages& pages) {
  const int file = ::memfd_create("attest-heap", MFD_CLOEXEC | MFD_ALLOW_SEALING);
  std::size_t written = 0;
  while (file >= 0 && written < pages.size) {
    const ssize_t count = ::write(file, pages.begin + written, pages.size - written);
    if (count <= 0) break;
    written += static_cast<std::size_t>(count);
  }
  constexpr int all_seals = F_SEAL_SEAL | F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE;
  if (file < 0 || (written == pages.size && ::fcntl(file, F_ADD_SEALS, all_seals) == 0))
    return file;
  ::close(file);
  return -1;
}

}  // namespace

void in_own_arena(const std::function<void()>& work) {
  pthread_attr_t attributes;
  ::pthread_attr_init(&attributes);
  ::pthread_attr_setstacksize(&attributes, stack_bytes);
  pthread_t thread{};
  void* const argument = const_cast<std::function<void()>*>(&work);
  const bool has_thread = ::pthread_create(&thread, &attributes, call, argument) == 0;
  ::pthread_attr_destroy(&attributes);
  if (has_thread) {
    ::pthread_join(thread, nullptr);
  } else {
    work();
  }
}

void make_heap_cheap_to_fork() {
  ::malloc_trim(0);
  const Pages pages = pages_of_heap();
  const int file = pages.size == 0 ? -1 : sealed_copy(pages);
  if (file < 0) return;
  // The bytes do not change between the copy and this call, which replaces the pages at once. If it
  // fails, the old pages stay.
  ::mmap(pages.begin, pages.size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_FIXED, file, 0);
  ::close(file);
}

}  // namespace attest
