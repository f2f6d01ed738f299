#include "harness/core/own_arena.hpp"

#include <thread>

namespace attest {

void in_own_arena(const std::function<void()>& work) { std::thread(work).join(); }

}  // namespace attest
