// Measures how much stack a function uses. The function runs on its own stack, which is filled with
// a pattern; the deepest changed byte marks the use.
#pragma once

#include <cstddef>
#include <type_traits>

#include "harness/core/result.hpp"

namespace attest {

// As large as the stack of a main thread (8 MiB), with a guard page below: a function that needs
// more dies of SIGSEGV, same as there. One thread at a time.
class PaintedStack {
 public:
  static Result<PaintedStack> make();  // errors: no memory

  PaintedStack(PaintedStack&& other) noexcept;
  PaintedStack& operator=(PaintedStack&&) = delete;
  ~PaintedStack();

  // Calls `work` on this stack and returns when it has returned. It must not throw. The modes of
  // the floating point unit are restored afterwards.
  template <typename Work>
  void run(Work&& work) {
    using Function = std::remove_reference_t<Work>;
    call([](void* function) { (*static_cast<Function*>(function))(); }, &work);
  }

  // The most bytes that one call of run() has used since the last repaint(), without those of run()
  // itself. Bytes that `work` reserves and never writes do not count below the deepest one written.
  std::size_t used() const;

  void repaint();

 private:
  explicit PaintedStack(unsigned char* memory) : memory_(memory) {}
  void call(void (*function)(void*), void* argument);
  std::size_t lowest_change() const;  // offset from the bottom

  unsigned char* memory_;  // the guard page, and the stack above it
  std::size_t own_ = 0;    // bytes that run() uses itself
};

}  // namespace attest
