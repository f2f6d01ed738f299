// SPDX-License-Identifier: BSD-3-Clause
// Judged: crash. Exits at step 20, after it wrote the beginning of an answer into every descriptor
// that is open: the head of a message for the outputs of 30 steps, and a byte of them.
#include <array>
#include <cstdint>
#include <cstring>
#include <string_view>

#include <attest_unit.h>
#include <unistd.h>

extern "C" const attest_unit* attest_starter_unit_v1(void);

namespace {

constexpr std::string_view head = "{\"request\": 1}";

// The layout in which MessageSocket sends it.
struct Prefix {
  std::uint32_t magic = 0xa77e57ff, blobs = 1;
  std::uint64_t head_bytes = head.size();
  std::array<std::uint64_t, 8> blob_bytes{30 * sizeof(attest_outputs)};
};

int step(void* self, const attest_inputs* in, attest_outputs* out) {
  static int steps = 0;
  if (++steps < 20) return attest_starter_unit_v1()->step(self, in, out);
  const Prefix prefix;
  std::array<char, sizeof prefix + head.size() + 1> begun{};
  std::memcpy(begun.data(), &prefix, sizeof prefix);
  std::memcpy(begun.data() + sizeof prefix, head.data(), head.size());
  for (int descriptor = 3; descriptor < 256; ++descriptor) {
    if (::write(descriptor, begun.data(), begun.size()) < 0) continue;
  }
  ::_exit(3);
}

}  // namespace

extern "C" const attest_unit* attest_unit_v1(void) {
  static const attest_unit unit = [] {
    attest_unit table = *attest_starter_unit_v1();
    table.name = "dies_in_answer";
    table.step = step;
    return table;
  }();
  return &unit;
}
