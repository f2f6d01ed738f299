#include "harness/diagnosis/hunt_trial.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "harness/diagnosis/hunt_lacks.hpp"
#include "harness/diagnosis/hunt_values.hpp"
#include "harness/golden/reference.hpp"
#include "harness/port/profiles.hpp"
#include "harness/verify/evaluate.hpp"
#include "harness/verify/reference_comparison.hpp"

namespace attest {
namespace {

// Correct ports compute in other forms, whose errors are like those of inputs that are wrong in
// their last bits. The tolerances hold where such errors have an effect that is smaller than this
// part of them: an attitude that differs by 1e-6 rad, amplified by a derivative over a short step,
// has a larger one.
constexpr double sure_part = 0.2;
// Of float inputs: 8 ulp. Quaternions of another form of the law differ by as much (tolerance.hpp).
constexpr double relative_noise = 0x1p-20;

// The trace up to the tick, with outputs of the reference.
Result<Trace> begin_of(const HuntInputs& inputs, std::size_t last_step) {
  HuntTrace parts(inputs);
  Trace begin;
  if (auto read = parts.next_part(last_step + 1, begin); !read) {
    return tl::unexpected(read.error());
  }
  return begin;
}

// Trials of errors; those with an even number have errors of one sign in each input.
constexpr std::uint64_t noise_trials = 4;

// The value with an error in its last bits.
double disturbed(const Channel& channel, double value, double sign) {
  const bool is_rotation = channel.quantity == Quantity::quaternion;
  return value + sign * relative_noise * (is_rotation ? 1 : std::abs(value));
}

Trace disturbed(const Trace& right, std::uint64_t number) {
  Trace inputs = right;
  HuntRandom random(1, number);
  for (std::size_t i = 0; i < channels().size(); ++i) {
    const Channel& channel = channels()[i];
    if (!right.present[i] || channel.is_output() || channel.type != ChannelType::f32) continue;
    double sign = random.chance(0.5) ? 1 : -1;
    for (Sample& sample : inputs.samples) {
      const double value = value_of(channel, sample);
      if (number % 2 == 1) sign = random.uniform(-1, 1);
      // A zero is zero in every port, but an attitude of another form has no zeros.
      const bool is_exact = value == 0 && channel.quantity != Quantity::quaternion;
      if (!is_exact && std::isfinite(value)) {
        set_value(channel, sample, disturbed(channel, value, sign));
      }
    }
  }
  return inputs;
}

// Whether `answered` differs from the right outputs by more than the sure part of the tolerances.
bool differs(const Trace& answered, const Trace& right) {
  return !compare(answered, right, Tolerances(Level::numeric).scaled(sure_part)).agrees();
}

bool is_by_precision(const HuntInputs& inputs, const Trace& right) {
  Trace in_double = right;
  const auto host = open_reference({}, Precision::binary64);
  if (host->drive(inputs.subject, in_double)) return true;
  if (differs(in_double, right)) return true;
  for (std::uint64_t number = 0; number < noise_trials; ++number) {
    const auto answered = reference_outputs(inputs.subject, disturbed(right, number));
    if (!answered || differs(*answered, right)) return true;
  }
  return false;
}

// Before the first attitude setpoint, the recovery of a tailsitter takes the direction of a vector
// of zeros, which depends on their signs.
bool recovers_without_setpoint(const Trace& right) {
  const auto enables = [](const ParameterChange& change) {
    return change.name == "VT_OPT_RECOV_EN" && change.value != 0;
  };
  const auto has_no_setpoint = [](const Sample& sample) {
    const auto& q = sample.in.vehicle_attitude_setpoint.q_d;
    return q[0] == 0 && q[1] == 0 && q[2] == 0 && q[3] == 0;
  };
  return module_of(right.present) == Module::mc_att_control &&
         std::ranges::any_of(right.parameters, enables) &&
         std::ranges::any_of(right.samples, has_no_setpoint);
}

// Whether rounding can explain the deviation.
bool is_excused(const HuntInputs& inputs, const VectorResult& failed) {
  if (!failed.first) return false;
  const std::size_t last_step = failed.first->tick;
  const auto right = begin_of(inputs, last_step);
  if (!right) return true;
  if (recovers_without_setpoint(*right)) return true;
  if (failed.verdict == Verdict::non_finite) return false;
  return first_near_decision(inputs.subject, *right, {}, last_step) ||
         is_by_precision(inputs, *right);
}

double deviation_of(const VectorResult& result) {
  if (result.worst && result.worst->tolerance > 0) {
    return std::abs(result.worst->got - result.worst->want) / result.worst->tolerance;
  }
  return result.tightest && result.tightest->ratio > 0 ? 1 / result.tightest->ratio : 0;
}

// The port, as one that lacks the outputs of the target. Notes which topics it publishes.
class HuntedPort final : public PortHost {
 public:
  HuntedPort(PortHost& host, const HuntTarget& target) : host_(host) {
    const Declarations& port = host.declarations();
    if (port.lacks.outputs == target.lacks.outputs) return;
    said_ = port;
    said_->lacks.outputs = target.lacks.outputs;
  }

  const Declarations& declarations() const override {
    return said_ ? *said_ : host_.declarations();
  }
  std::optional<PortFault> drive(const ModuleUnderTest& subject, Trace& trace) override {
    auto fault = host_.drive(subject, trace);
    published_ |= published_in(trace);
    has_fault_ = has_fault_ || fault;
    return fault;
  }
  Result<Flown> fly(const FlightPlan& plan) override { return host_.fly(plan); }
  Result<LiveFlight> fly_live(const LivePlan& plan, const LiveWatch& watch) override {
    return host_.fly_live(plan, watch);
  }
  Result<StepTimes> time_steps(const ModuleUnderTest& subject, const Trace& inputs,
                               bool with_stack) override {
    return host_.time_steps(subject, inputs, with_stack);
  }
  bool supports(const std::string& profile) override { return host_.supports(profile); }

  const HuntTopicSet& published() const { return published_; }
  bool has_fault() const { return has_fault_; }

 private:
  PortHost& host_;
  std::optional<Declarations> said_;
  HuntTopicSet published_;
  bool has_fault_ = false;
};

}  // namespace

void make_orderly(const Lacks& lacks, HuntInputs& inputs) {
  const ProfileInfo* const profile = find_profile(inputs.subject.profile);
  if (profile == nullptr) return;
  std::ranges::stable_sort(inputs.parameters, {}, [](const ParameterChange& change) {
    return std::tuple(change.tick, std::string_view(change.name));
  });
  std::map<std::string, float> values;
  for (const Parameter& known : parameters_of(inputs.subject.module, *profile)) {
    const std::string name(known.name);
    const ConstantParameter* const constant = lacks.constant(name);
    const auto is_this = [&](const ParameterChange& change) { return change.name == name; };
    if (constant != nullptr) std::erase_if(inputs.parameters, is_this);
    const float usual = constant != nullptr ? constant->value : known.default_value;
    const auto first = std::ranges::find_if(inputs.parameters, is_this);
    const bool is_late = first != inputs.parameters.end() && first->tick > 0;
    if (is_late || usual != known.default_value) {
      inputs.parameters.insert(inputs.parameters.begin(), {0, name, usual});
    }
  }
  std::ranges::stable_sort(inputs.parameters, {}, [](const ParameterChange& change) {
    return std::tuple(change.tick, std::string_view(change.name));
  });
  std::erase_if(inputs.parameters, [&](const ParameterChange& change) {
    const auto [value, is_first] = values.try_emplace(change.name, change.value);
    const bool is_same = !is_first && (value->second == change.value ||
                                       (std::isnan(value->second) && std::isnan(change.value)));
    value->second = change.value;
    return is_same;
  });
}

Result<HuntTrial> judge_trial(const HuntInputs& inputs, const HuntTarget& target, PortHost& host) {
  HuntTrial trial;
  const Level level = target.level;
  if (uses_lacking(target.lacks, inputs)) return trial;
  HuntTrace parts(inputs, &trial.meets);
  HuntedPort port(host, target);
  auto result = evaluate_parts(parts, inputs.subject, port, Tolerances(level));
  if (!result) return tl::unexpected(result.error());
  trial.steps = inputs.steps();
  if (!port.has_fault()) {
    trial.due = parts.published();
    trial.published = port.published();
  }
  const bool has_outputs =
      (parts.present() & channels_of(inputs.subject.module, "out/") & ~target.lacks.outputs).any();
  if (!has_outputs && !port.has_fault()) return trial;
  trial.deviation = level == Level::exact ? 0 : deviation_of(*result);
  trial.agrees = result->verdict == Verdict::pass;
  if (!fails_a_run(result->verdict)) return trial;
  if (level != Level::exact && is_excused(inputs, *result)) {
    trial.deviation = 0;
    return trial;
  }
  trial.deviation = std::max(trial.deviation, 1.0);
  result->profile = inputs.subject.profile;
  result->group = hunt_group;
  result->name = name_of(inputs.subject.module);
  result->rate = inputs.rate;
  result->compared = level;
  trial.failure = *std::move(result);
  return trial;
}

}  // namespace attest
