// How attest uses Boost.Math: in double, so that the results are the same where long double is of
// another size, and without exceptions for values that overflow.
#pragma once

#include <boost/math/policies/policy.hpp>

namespace attest {

using BoostPolicy = boost::math::policies::policy<
    boost::math::policies::promote_double<false>,
    boost::math::policies::overflow_error<boost::math::policies::ignore_error>>;

}  // namespace attest
