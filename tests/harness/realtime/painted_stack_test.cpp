#include "harness/realtime/painted_stack.hpp"

#include <gtest/gtest.h>

#include "harness/core/sanitizers.hpp"

namespace attest {
namespace {

// Neither inlined, which would use the stack of its caller, nor optimised away.
template <std::size_t bytes>
[[gnu::noinline]] unsigned char use_stack() {
  volatile unsigned char memory[bytes];
  for (std::size_t i = 0; i < bytes; i += 512) memory[i] = static_cast<unsigned char>(i);
  return memory[0];
}

// A sanitizer adds memory around each variable.
constexpr std::size_t slack = 2048;

TEST(PaintedStack, MeasuresTheDeepestCall) {
  auto stack = PaintedStack::make();
  ASSERT_TRUE(stack) << stack.error().to_string();
  EXPECT_EQ(stack->used(), 0u);
  stack->run([] { use_stack<65536>(); });
  stack->run([] { use_stack<512>(); });
  EXPECT_GE(stack->used(), 65536u);
  EXPECT_LE(stack->used(), 65536u + slack);
}

TEST(PaintedStack, ForgetsWhenItIsRepainted) {
  auto stack = PaintedStack::make();
  ASSERT_TRUE(stack);
  stack->run([] { use_stack<65536>(); });
  stack->repaint();
  EXPECT_EQ(stack->used(), 0u);
  stack->run([] { use_stack<8192>(); });
  EXPECT_GE(stack->used(), 8192u);
  EXPECT_LE(stack->used(), 8192u + slack);
}

TEST(PaintedStack, WorkSeesItsVariables) {
  auto stack = PaintedStack::make();
  ASSERT_TRUE(stack);
  int sum = 0;
  for (int i = 1; i <= 100; ++i) stack->run([&] { sum += i; });
  EXPECT_EQ(sum, 5050);
}

// The frame in which attest makes the call does not count.
TEST(PaintedStack, WorkThatDoesNothingUsesNothing) {
  auto stack = PaintedStack::make();
  ASSERT_TRUE(stack);
  stack->run([] {});
  // Of the test's own, unoptimised call; a sanitizer adds to it.
  EXPECT_LE(stack->used(), built_with_sanitizers ? 128u : 96u);
}

}  // namespace
}  // namespace attest
