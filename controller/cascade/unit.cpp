#include "controller/cascade/unit.hpp"

#include "controller/cascade/unit_table.hpp"

#ifndef ATTEST_REFERENCE_SCALAR
#define ATTEST_REFERENCE_SCALAR float
#endif

#ifndef ATTEST_REFERENCE_VERSION
#define ATTEST_REFERENCE_VERSION "unversioned"
#endif

namespace attest::cascade {
namespace {

template <typename Scalar>
constexpr attest_unit table{ATTEST_UNIT_ABI_VERSION,
                            "attest-cascade",
                            ATTEST_REFERENCE_VERSION,
                            nullptr,
                            nullptr,
                            nullptr,
                            nullptr,
                            extension<Scalar>};

}  // namespace

const attest_unit* cascade_unit() { return &table<ATTEST_REFERENCE_SCALAR>; }

const attest_unit* cascade_unit_in_double() { return &table<double>; }

}  // namespace attest::cascade
