// What a port declares that it has not: features of the law, outputs, and parameters that are
// constants in it. What it declares is not judged, and the rest is.
//
//     sticks                          a feature: `attest list --features`
//     rate_ctrl_status                an output topic
//     actuator_controls_0.control[7]  an output; `*` stands for any text
//     MC_YAW_FF=0.5                   a parameter that is a constant, and its value
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "controller/attest_unit.h"
#include "harness/core/result.hpp"
#include "harness/port/features.hpp"
#include "harness/trace/channels.hpp"

namespace attest {

// A parameter that is a constant in the port.
struct ConstantParameter {
  std::string name;
  float value;

  // The result of set_parameter(). The port is asked for another value only. If it takes that, the
  // declaration is not true.
  template <typename Ask>
  int answer_to(float wanted, Ask ask) const {
    return wanted == value || ask() == ATTEST_OK ? ATTEST_OK : ATTEST_UNSUPPORTED;
  }
};

struct Lacks {
  std::vector<std::string> words;  // as declared
  FeatureSet features;
  ChannelSet outputs;
  std::vector<ConstantParameter> constants;

  bool any() const { return !words.empty(); }
  const ConstantParameter* constant(std::string_view parameter) const;  // null: it is none

  // Errors: a word that is no feature, output or parameter; a parameter that has two values.
  static Result<Lacks> parse(std::span<const std::string> words);
};

// "MC_YAW_FF=0.5", separated.
std::string text_of(std::span<const ParameterChange> parameters, std::string_view separator);

// Parses "NAME=VALUE". Errors: other text; a value that is no finite number.
Result<ParameterChange> parse_parameter(const std::string& text);

}  // namespace attest
