#include "harness/sweep/sample_stream.hpp"

#include <array>
#include <cstddef>

#include <openssl/sha.h>

namespace attest {
namespace {

void append(std::uint64_t number, std::string& bytes) {
  for (int shift = 0; shift < 64; shift += 8) bytes.push_back(static_cast<char>(number >> shift));
}

}  // namespace

std::uint64_t SampleStream::bits(Purpose purpose, std::uint64_t sample, std::uint64_t item) const {
  std::string block = seed_;
  block.push_back(static_cast<char>(purpose));
  append(sample, block);
  append(item, block);
  std::array<unsigned char, SHA256_DIGEST_LENGTH> digest;
  SHA256(reinterpret_cast<const unsigned char*>(block.data()), block.size(), digest.data());
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < sizeof number; ++i) number |= std::uint64_t{digest[i]} << (8 * i);
  return number;
}

double open_uniform(std::uint64_t bits) {
  return (static_cast<double>(bits >> 12) + 0.5) * 0x1p-52;
}

}  // namespace attest
