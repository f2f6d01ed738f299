// The exact path of the elementary functions: plain series in integers, for every finite argument.
//
// It takes microseconds (2 to 15 on a PC) and needs no C library. elementary.cpp uses it where the
// fast path cannot decide between two floats, about once in 500,000 random arguments.
//
// Pure functions; any thread.
#pragma once

namespace attest::elementary::exact {

float sin(float x);
float cos(float x);
float tan(float x);
float asin(float x);  // REQUIRES: |x| <= 1, same for acos()
float acos(float x);
float exp(float x);
float atan2(float y, float x);  // REQUIRES: neither is 0

}  // namespace attest::elementary::exact
