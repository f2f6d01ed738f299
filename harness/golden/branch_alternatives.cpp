#include "harness/golden/branch_alternatives.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>

#include <fmt/format.h>

#include "controller/reference/mc_att_control_definition.hpp"
#include "harness/compare/compare.hpp"
#include "harness/golden/margins.hpp"

namespace attest {
namespace {

using Vector3f = reference::Vector3<float>;
using Matrix3f = reference::Matrix3<float>;

struct OtherBranch : reference::AttitudeStages<float> {
  using Law = reference::AttitudeStages<float>;
  EitherBranch branches;

  float yaw_error(const Vector3f& nose, const Matrix3f& R_WD, float weight) const {
    const float error = Law::yaw_error(nose, R_WD, weight);
    const auto margin = static_cast<float>(least_margin(Decision::yaw_wrap));
    const float from_wrap = std::numbers::pi_v<float> - std::abs(error / weight);
    return branches.yaw_wrap && from_wrap < margin ? -error : error;
  }
  Vector3f direct_error(const Matrix3f& R_WB, const Matrix3f& R_WD) const {
    const Vector3f error = Law::direct_error(R_WB, R_WD);
    const auto q = reference::quaternion_of(reference::ordered::transpose_product(R_WB, R_WD));
    const auto margin = static_cast<float>(least_margin(Decision::shorter_rotation));
    const bool is_near = branches.shorter_rotation && std::abs(q.w()) < margin;
    return is_near ? Vector3f(-error) : error;
  }
};

struct LawOnOtherBranch {
  reference::StepStages<float> step;
  OtherBranch attitude;
  reference::RateStages<float> rate;
  reference::RecoveryStages<float> recovery;
};

// Compares outputs value by value, because the padding between the members of a topic has no
// meaning.
bool is_same(std::string_view prefix, const Sample& a, const Sample& b) {
  const ChannelSet chosen = channels_of(Module::mc_att_control, prefix);
  for (std::size_t i = 0; i < channels().size(); ++i) {
    const Channel& channel = channels()[i];
    if (!chosen[i] || !channel.is_output()) continue;
    const double x = value_of(channel, a), y = value_of(channel, b);
    if (std::bit_cast<std::uint64_t>(x) != std::bit_cast<std::uint64_t>(y)) return false;
  }
  return true;
}

// Compares one tick alone, with the parameters that are in force at it.
bool agrees(const Trace& got, const Trace& want, std::size_t tick, const Tolerances& tolerances) {
  const auto& all = want.parameters;
  const auto later = std::find_if(
      all.begin(), all.end(), [tick](const ParameterChange& change) { return change.tick > tick; });
  TickComparer comparer(want.present, want.present, tolerances);
  comparer.add(got.samples[tick], want.samples[tick], {all.begin(), later});
  return comparer.finish(1, 1).agrees();
}

// The trace that `got` agrees with at this tick, `law` first; null if there is none.
const Trace* branch_of(const Trace& got, const Trace& law, const BranchAlternatives& others,
                       std::size_t tick, const Tolerances& tolerances) {
  if (agrees(got, law, tick, tolerances)) return &law;
  for (const auto& [name, other] : others) {
    if (agrees(got, other, tick, tolerances)) return &other;
  }
  return nullptr;
}

Result<Trace> answers_of(const EitherBranch& branches, const Case& the_case, const Trace& law) {
  const auto profile = reference::profile_from_name(the_case.profile);
  if (!profile) return fail_at(the_case.file.string(), "either_branch: no such profile");
  LawOnOtherBranch stages;
  stages.attitude.branches = branches;
  reference::McAttControl<float, LawOnOtherBranch> control(*profile, stages);
  Trace other = law;
  PendingChanges changes(law.parameters);
  attest_outputs out{};
  bool any = false;
  for (std::size_t tick = 0; tick < other.samples.size(); ++tick) {
    for (const ParameterChange& change : changes.take_until(tick)) {
      control.set_parameter(change.name, change.value);
    }
    Sample& sample = other.samples[tick];
    control.step(sample.in, out);
    sample.out = out;
    any = any || !is_same("out/", sample, law.samples[tick]);
    if (!is_same("out/mc_att_ctrl_status.", sample, law.samples[tick])) {
      return fail_at(
          the_case.file.string(),
          fmt::format("either_branch: at tick {} the integrals are not those of the other "
                      "branch; keep them from moving, for example by a thrust of 0.15",
                      tick));
    }
  }
  if (!any) {
    return fail_at(the_case.file.string(), "either_branch: no tick stands on such a threshold");
  }
  return other;
}

}  // namespace

Result<BranchAlternatives> branch_alternatives(const Case& the_case, const Trace& law) {
  const EitherBranch allowed = the_case.either_branch;
  BranchAlternatives others;
  for (const EitherBranch branches : {EitherBranch{true, false}, {false, true}, {true, true}}) {
    if ((branches.yaw_wrap && !allowed.yaw_wrap) ||
        (branches.shorter_rotation && !allowed.shorter_rotation)) {
      continue;
    }
    auto answers = answers_of(branches, the_case, law);
    if (!answers) return tl::unexpected(answers.error());
    std::string name = branches.yaw_wrap ? "yaw_wrap" : "shorter_rotation";
    if (branches.yaw_wrap && branches.shorter_rotation) name += "+shorter_rotation";
    others[name] = std::move(*answers);
  }
  return others;
}

Trace on_the_branch_of(const Trace& got, const Trace& law, const BranchAlternatives& others,
                       const Tolerances& tolerances) {
  Trace want = law;
  for (std::size_t tick = 0; tick < want.samples.size(); ++tick) {
    // An output that is wrong on every branch is compared with the nearest branch.
    const Trace* branch = nullptr;
    for (double factor = 1; branch == nullptr && factor <= 1e4; factor *= 10) {
      branch = branch_of(got, law, others, tick, tolerances.scaled(factor));
    }
    if (branch != nullptr) want.samples[tick] = branch->samples[tick];
  }
  return want;
}

}  // namespace attest
