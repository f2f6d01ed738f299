// The policy of Boost.Math in sweeps. It computes in double, so that results do not depend on the
// size of long double, and throws no exception on overflow.
#pragma once

#include <boost/math/policies/policy.hpp>

namespace attest {

using BoostPolicy = boost::math::policies::policy<
    boost::math::policies::promote_double<false>,
    boost::math::policies::overflow_error<boost::math::policies::ignore_error>>;

}  // namespace attest
