// How many times operator new has run in this program; never decreases. Any thread.
#pragma once

#include <cstddef>

namespace attest::test {

std::size_t allocation_count();

}  // namespace attest::test
