// Measures how much stack a function uses. The function runs on a separate stack, which is filled
// with a pattern. The deepest byte that has changed shows the use.
#pragma once

#include <cstddef>
#include <type_traits>

#include "harness/core/result.hpp"

namespace attest {

// Is as large as the stack of a main thread, with a guard page below. A function that needs
// more gets SIGSEGV, same as in a main thread. For one thread at a time.
class PaintedStack {
 public:
  static constexpr std::size_t size = 8u << 20;  // [bytes]

  static Result<PaintedStack> make();  // errors: no memory

  PaintedStack(PaintedStack&& other) noexcept;
  PaintedStack& operator=(PaintedStack&&) = delete;
  ~PaintedStack();

  // Calls `work` on this stack, and restores the modes of the floating point unit afterwards.
  // REQUIRES: `work` does not throw.
  template <typename Work>
  void run(Work&& work) {
    using Function = std::remove_reference_t<Work>;
    call([](void* function) { (*static_cast<Function*>(function))(); }, &work);
  }

  // The largest use of a call of run() since the last repaint() [bytes], without the use of run()
  // itself. It ends at the deepest byte written, so stack that `work` reserves below it and never
  // writes does not count.
  std::size_t used() const;

  void repaint();

 private:
  explicit PaintedStack(unsigned char* memory) : memory_(memory) {}
  void call(void (*function)(void*), void* argument);
  std::size_t lowest_change() const;  // offset from the bottom of the stack

  unsigned char* memory_;  // the guard page, and the stack above it
  std::size_t own_ = 0;    // bytes that run() uses itself
};

}  // namespace attest
