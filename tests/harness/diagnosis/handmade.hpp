// A port made by hand, for tests of the search: each fault adds numbers to some outputs of some
// vectors of one tick, and a port is a sum of faults and of mistakes that are no fault.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "harness/diagnosis/diagnose.hpp"

namespace attest {

// Faults of three stages, in the order of the catalogue.
inline constexpr const char* tilt_fault = "tilt-in-world";
inline constexpr const char* yaw_fault = "yaw-weight-dropped";
inline constexpr const char* tpa_fault = "tpa-missing";

class HandMade {
 public:
  static constexpr std::size_t outputs = 4;
  using Vector = std::array<double, outputs>;

  // Vectors of which the first ones failed.
  HandMade(std::size_t failing, std::size_t passing)
      : failing_(failing), passing_(passing), port_(failing + passing) {}

  // The fault adds `value` to an output of the vectors from `first` to before `end`.
  HandMade& acts(std::string_view fault, std::size_t first, std::size_t end, std::size_t output,
                 double value) {
    std::vector<Vector>& effect = effects_[fault];
    effect.resize(failing_ + passing_);
    for (std::size_t v = first; v < end; ++v) effect.at(v).at(output) += value;
    return *this;
  }
  // The port has this fault.
  HandMade& has(std::string_view fault) {
    for (std::size_t v = 0; v < port_.size(); ++v) add(effects_.at(fault)[v], port_[v]);
    return *this;
  }
  // The port has a mistake that is no fault.
  HandMade& differs(std::size_t first, std::size_t end, std::size_t output, double value) {
    for (std::size_t v = first; v < end; ++v) port_.at(v).at(output) += value;
    return *this;
  }
  // While both act, `fault` acts in place of `other`, as if both replace one stage of the law.
  HandMade& replaces(std::string_view fault, std::string_view other) {
    replaces_[fault] = other;
    return *this;
  }
  // In these vectors a mistake that is no fault deviates a tick before all faults.
  HandMade& deviates_before(std::size_t first, std::size_t end) {
    for (std::size_t v = first; v < end; ++v) parts_[v] = 0;
    return *this;
  }
  // In these vectors a mistake that is no fault deviates a tick after all faults.
  HandMade& deviates_after(std::size_t first, std::size_t end) {
    for (std::size_t v = first; v < end; ++v) parts_[v] = 2;
    return *this;
  }
  HandMade& deviates_first(std::size_t vector, Stage stage) {
    stages_[vector] = stage;
    return *this;
  }

  Evidence evidence() const {
    Evidence evidence;
    evidence.failing = failing_;
    evidence.passing = passing_;
    evidence.compare = [this](const auto& vectors, const auto& hypotheses) {
      std::vector<VectorSimilarity> all;
      for (const std::size_t v : vectors) all.push_back(compared(v, hypotheses));
      return all;
    };
    return evidence;
  }
  std::optional<Diagnosis> diagnosed() const { return diagnose(evidence()); }

 private:
  static void add(const Vector& effect, Vector& sum) {
    for (std::size_t i = 0; i < outputs; ++i) sum[i] += effect[i];
  }

  VectorSimilarity compared(std::size_t v, const std::vector<Hypothesis>& hypotheses) const {
    VectorSimilarity vector;
    vector.ticks = 1;
    vector.case_id = "case " + std::to_string(v);
    if (stages_.contains(v)) vector.stage = stages_.at(v);
    for (std::size_t i = 0; i < outputs; ++i) {
      if (port_[v][i] != 0) vector.deviating |= 1U << i;
      vector.misfit += std::log2(1 + std::abs(port_[v][i]));
    }
    for (const Hypothesis& hypothesis : hypotheses) {
      Vector sum{};
      for (const faults::Fault* fault : hypothesis) {
        const bool is_replaced = std::ranges::any_of(hypothesis, [&](const faults::Fault* one) {
          const auto place = replaces_.find(one->id);
          return place != replaces_.end() && place->second == fault->id;
        });
        if (is_replaced) continue;
        const auto effect = effects_.find(fault->id);
        if (effect != effects_.end()) add(effect->second[v], sum);
      }
      Similarity one;
      for (std::size_t i = 0; i < outputs; ++i) {
        if (sum[i] != 0) one.deviating |= 1U << i;
        if (sum[i] != port_[v][i]) one.parted |= 1U << i;
        one.misfit += std::log2(1 + std::abs(sum[i] - port_[v][i]));
      }
      if (one.deviating != 0) one.acts = 1;
      if (one.parted != 0) one.parts = parts_.contains(v) ? parts_.at(v) : 1;
      one.matched = one.parted == 0 ? 1 : 0;
      vector.similarities.push_back(one);
    }
    return vector;
  }

  std::size_t failing_, passing_;
  std::map<std::string_view, std::vector<Vector>> effects_;
  std::vector<Vector> port_;
  std::map<std::size_t, Stage> stages_;
  std::map<std::size_t, std::size_t> parts_;  // the tick at which port and faults part
  std::map<std::string_view, std::string_view> replaces_;
};

inline std::vector<std::string_view> ids_of(const std::vector<const faults::Fault*>& faults) {
  std::vector<std::string_view> ids;
  for (const faults::Fault* fault : faults) ids.push_back(fault->id);
  return ids;
}

inline std::vector<std::string_view> suspected(const Diagnosis& diagnosis) {
  std::vector<const faults::Fault*> faults;
  for (const Suspect& suspect : diagnosis.suspects) faults.push_back(suspect.fault);
  return ids_of(faults);
}

}  // namespace attest
