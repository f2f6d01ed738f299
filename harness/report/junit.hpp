// The report for CI servers, in the JUnit dialect that Jenkins, GitLab and GitHub's reporters have
// in common (tests/harness/report/junit.xsd).
//
// A group is a testsuite, a vector is a testcase, and the failure text is the content of <failure>
// (fail, non-finite, xpass) or <error> (crash, timeout, protocol): GitLab shows content, not
// `message`. For a vector with a first deviation, the content includes the run's diagnosis.
// unsupported, skip and xfail are <skipped>. Of testcases with equal classname and name, GitLab
// shows only the first one, so the name has the rate. Errors of the environment are a testsuite of
// their own, "attest.environment". The time of a testcase is that of its vector; other times are
// sums.
#pragma once

#include <optional>
#include <string>

#include "harness/diagnosis/diagnose.hpp"
#include "harness/verify/run_result.hpp"

namespace attest {

std::string junit_report(const RunResult& run, const std::optional<Diagnosis>& diagnosis = {});

}  // namespace attest
