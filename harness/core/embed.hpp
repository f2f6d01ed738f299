// Files that are parts of the binary; the assembler includes them. The CMake function
// attest_embed() defines a macro with the path of each.
#pragma once

#include <cstddef>
#include <string_view>

// Puts the bytes of the file at `path` into the binary, with a zero behind them, and declares them.
// Use it outside of namespaces.
#define ATTEST_EMBED(name, path)       \
  asm(".section .rodata\n"             \
      ".global attest_embedded_" #name \
      "\n"                             \
      ".global attest_embedded_" #name \
      "_end\n"                         \
      "attest_embedded_" #name         \
      ":\n"                            \
      ".incbin \"" path                \
      "\"\n"                           \
      "attest_embedded_" #name         \
      "_end:\n"                        \
      ".byte 0\n"                      \
      ".previous\n");                  \
  extern "C" const char attest_embedded_##name[], attest_embedded_##name##_end[]

// The bytes of the file, without the zero, as a std::string_view.
#define ATTEST_EMBEDDED(name) \
  ::attest::embedded_between(attest_embedded_##name, attest_embedded_##name##_end)

namespace attest {

inline std::string_view embedded_between(const char* begin, const char* end) {
  return {begin, static_cast<std::size_t>(end - begin)};
}

}  // namespace attest
