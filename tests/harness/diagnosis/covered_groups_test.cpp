#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "controller/faults/fault.hpp"
#include "harness/golden/recorded.hpp"
#include "harness/host/in_process_host.hpp"
#include "harness/port/fault_port.hpp"
#include "harness/verify/evaluate.hpp"
#include "harness/verify/recorded_check.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;

const fs::path recorded_folder = fs::path(ATTEST_SOURCE_DIR) / "golden" / "recorded";

std::vector<Recorded> all_recordings() {
  std::vector<Recorded> all;
  for (const auto& entry : fs::recursive_directory_iterator(recorded_folder)) {
    if (entry.path().extension() != ".csv") continue;
    auto one = read_recorded(entry.path());
    EXPECT_TRUE(one) << entry.path();
    if (one) all.push_back(std::move(*one));
  }
  return all;
}

// Whether a recording of the profile distinguishes some mistake of the group from the law.
bool tells_a_mistake_of(const std::string& group, const std::string& profile,
                        const std::vector<Recorded>& recordings) {
  for (const faults::Fault* fault : faults::catalogue()) {
    if (fault->group != group || !fault->is_detectable(profile)) continue;
    InProcessHost host(*open_fault(fault->id));
    for (const Recorded& one : recordings) {
      if (one.subject.profile != profile) continue;
      const VectorResult result =
          evaluate_trace(one.trace, one.subject, host, Tolerances(Level::numeric));
      if (fails_a_run(result.verdict)) return true;
    }
  }
  return false;
}

TEST(CoveredGroups, EveryGroupThatTheyClaimToCoverHasAMistakeThatTheyTell) {
  const auto covered = covered_groups(recorded_folder);
  ASSERT_TRUE(covered) << covered.error().to_string();
  EXPECT_EQ(covered->size(), 127u);
  const auto recordings = all_recordings();
  for (const std::string& name : *covered) {
    const auto slash = name.find('/');
    EXPECT_TRUE(tells_a_mistake_of(name.substr(slash + 1), name.substr(0, slash), recordings))
        << name;
  }
}

TEST(CoveredGroups, AGroupThatTheyDoNotShowIsNotCovered) {
  const auto covered = covered_groups(recorded_folder);
  ASSERT_TRUE(covered);
  EXPECT_FALSE(covered->contains("px4-v1.5.5/flight"));
  EXPECT_FALSE(covered->contains("px4-v1.3.4/mixer"));
}

}  // namespace
}  // namespace attest
