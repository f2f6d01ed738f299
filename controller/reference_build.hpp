// What a build of the reference can choose: its version and its scalar (tests/ports).
#pragma once

#ifndef ATTEST_REFERENCE_VERSION
#define ATTEST_REFERENCE_VERSION "unversioned"
#endif

#ifndef ATTEST_REFERENCE_SCALAR
#define ATTEST_REFERENCE_SCALAR float
#endif
