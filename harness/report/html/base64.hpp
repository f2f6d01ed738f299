// Base64 (RFC 4648, with padding), for binary data in a text.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace attest {

std::string base64(std::string_view bytes);

// Base64 of the bytes of the numbers, least significant byte first.
std::string base64(std::span<const float> numbers);

}  // namespace attest
