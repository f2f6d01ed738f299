// The part of the proof that CI runs.
#pragma once

#include <cstdint>

namespace attest::elementary {

// False if a result differs from the correctly rounded one, the hash of a share that RESULTS.md
// keeps has changed, or the C library's functions are less accurate than truth() assumes. Prints
// what was compared.
bool check(std::uint64_t every, unsigned threads);

}  // namespace attest::elementary
