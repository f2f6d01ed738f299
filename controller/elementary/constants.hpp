// The constants of the elementary functions. Printed by constants.py, which derives them.
#pragma once

#include <cstdint>

// clang-format off
namespace attest::elementary {

// Of the exact path. Limbs of 32 bits, the least significant first; the last is the integer part.
// Bits beyond the fraction are cut off.
inline constexpr std::uint32_t two_over_pi[12] = {
    0x06492eea, 0x424dd2e0, 0xb7246e3a, 0xdebbc561, 0xfe5163ab, 0x3c439041, 0xdb629599, 0xf534ddc0,
    0xfc2757d1, 0x4e441529, 0xa2f9836e, 0x00000000};
inline constexpr std::uint32_t half_pi[7] = {
    0x14cf98e8, 0x52049c11, 0x01b839a2, 0x898cc517, 0x42d18469, 0x921fb544, 0x00000001};
inline constexpr std::uint32_t ln2[7] = {
    0x7298b62d, 0x40f34326, 0x03f2f6af, 0xc9e3b398, 0xd1cf79ab, 0xb17217f7, 0x00000000};

// Of the fast path, in double: a table, and coefficients of polynomials in x^2.
// atan(i/16)
inline constexpr double arc_tangents[17] = {
    0x0.0p+0, 0x1.ff55bb72cfdeap-5, 0x1.fd5ba9aac2f6ep-4, 0x1.7b97b4bce5b02p-3,
    0x1.f5b75f92c80ddp-3, 0x1.362773707ebccp-2, 0x1.6f61941e4def1p-2, 0x1.a64eec3cc23fdp-2,
    0x1.dac670561bb4fp-2, 0x1.0657e94db30d0p-1, 0x1.1e00babdefeb4p-1, 0x1.345f01cce37bbp-1,
    0x1.4978fa3269ee1p-1, 0x1.5d58987169b18p-1, 0x1.700a7c5784634p-1, 0x1.819d0b7158a4dp-1,
    0x1.921fb54442d18p-1};
// sin(x) / x and cos(x) for x^2 up to 0.617, which is above (pi/4)^2
inline constexpr double sine_terms[6] = {
    0x1.fffffffffffd9p-1, -0x1.5555555550ee8p-3, 0x1.1111110bdd143p-7, -0x1.a019f8a05bdb2p-13,
    0x1.71d7309c91284p-19, -0x1.a9502ee3faf9bp-26};
inline constexpr double cosine_terms[7] = {
    0x1.0000000000000p+0, -0x1.fffffffffff79p-2, 0x1.555555554e7c9p-5, -0x1.6c16c163c396dp-10,
    0x1.a019f7fbbcd83p-16, -0x1.27df3f5480c13p-22, 0x1.1b8abfc6d4aacp-29};
// asin(x) / x for x^2 up to 1/4
inline constexpr double arc_sine_terms[12] = {
    0x1.ffffffffffffep-1, 0x1.55555555575c2p-3, 0x1.333333303170bp-4, 0x1.6db6dd2b73dbcp-5,
    0x1.f1c697a18546ap-6, 0x1.6e9740e3189a8p-6, 0x1.1baaecd4ba09fp-6, 0x1.d56064cb0440cp-7,
    0x1.333f8f5ab3614p-7, 0x1.2b1cc45aae156p-6, -0x1.7f2cb01282bedp-7, 0x1.02164e2579227p-5};

}  // namespace attest::elementary
