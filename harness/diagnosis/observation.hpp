// How a port deviates on one vector from what is expected of it: in which outputs, under which
// conditions, and how its values relate to the expected ones. For mistakes that are no fault of the
// catalogue.
#pragma once

#include <compare>
#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "harness/diagnosis/conditions.hpp"
#include "harness/diagnosis/similarity.hpp"

namespace attest {

// The outputs of one stage about one axis.
struct OutputsOf {
  Stage stage = Stage::input;
  int axis = -1;  // 0 roll, 1 pitch, 2 yaw; -1: the output has no axis

  friend auto operator<=>(const OutputsOf&, const OutputsOf&) = default;
};

// The stage of a first deviation.
struct FirstStage {
  Stage counted = Stage::input;  // as reports count it (stage_of())
  Stage written = Stage::input;  // that of the output (OutputsOf::stage)

  friend auto operator<=>(const FirstStage&, const FirstStage&) = default;
};

// Values that deviate and values that agree, while a condition holds.
struct Tally {
  std::size_t deviating = 0, agreeing = 0;
};

// How deviating values relate to the expected ones. Each number counts deviating values.
struct Relations {
  std::size_t values = 0;
  std::size_t cleared = 0;   // 0 where the topic is not published
  std::size_t zero = 0;      // 0, and published
  std::size_t reversed = 0;  // the expected value with the other sign
  std::size_t late = 0;      // the expected value of the step before
  // Values of the expected sign, but smaller: their smallest and largest size.
  std::size_t smaller = 0;
  double smaller_from = std::numeric_limits<double>::max(), smaller_to = 0;
  // Of values that are not too small for it, the quotient: the port's value by the expected one.
  std::size_t quotients = 0;
  double quotient_from = std::numeric_limits<double>::max(),
         quotient_to = std::numeric_limits<double>::lowest();

  void add(const Relations& other);
};

// The values at which a condition holds.
struct Where {
  std::string condition;  // "the tilt error exceeds 90 deg"
  Tally tally;
  ConditionKind kind = ConditionKind::law;
};

struct Observed {
  Tally all;                 // without a condition
  std::vector<Where> where;  // in the order of conditions_of()
  Relations relations;

  void add(const Observed& other);
};

// A value deviates here if the step makes it deviate. An integral deviates in its change, and a
// torque apart from the integral's deviation in the step before.
using Observation = std::map<OutputsOf, Observed>;

// `given` has the inputs; `port` and `expected` have the outputs.
Observation observe(const Trace& given, const Outputs& port, const Outputs& expected,
                    const ModuleUnderTest& subject, const Tolerances& tolerances);

nlohmann::json to_json(const Observation& observation);
Observation observation_from(const nlohmann::json& in);

}  // namespace attest
