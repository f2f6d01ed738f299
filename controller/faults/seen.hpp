// Values that a fault in one stage of the rate loop needs from another stage.
#pragma once

#include <memory>

#include "controller/faults/faulty_law.hpp"

namespace attest::faults {

// Inputs of one stage, recorded for another stage of the same step.
struct Seen {
  Vector error = Vector::Zero();
  float attenuation = 1;
  float dt_s = 0;
  Vector last = Vector::Zero();
};

// Records the error, the attenuation and dt, which are not arguments of the later stages.
inline std::shared_ptr<Seen> watch(FaultyLaw& law) {
  auto seen = std::make_shared<Seen>();
  change_stage(law.rate.proportional, [seen](const auto& then, const Vector& error,
                                             float attenuation, const RateGains& gains) {
    seen->error = error;
    seen->attenuation = attenuation;
    return then(error, attenuation, gains);
  });
  change_stage(law.rate.derivative, [seen](const auto& then, const Vector& prev,
                                           const Vector& rates, float dt, const RateGains& gains) {
    seen->dt_s = dt;
    return then(prev, rates, dt, gains);
  });
  return seen;
}

// The terms of the control.
struct ControlTerms {
  Vector p, d, i, ff;
};

// Changes the terms before they are added. Change is void(ControlTerms&).
template <typename Change>
void change_terms(FaultyLaw& law, Change change) {
  change_stage(law.rate.control, [change](const auto& then, const Vector& p, const Vector& d,
                                          const Vector& i, const Vector& ff) {
    ControlTerms terms{p, d, i, ff};
    change(terms);
    return then(terms.p, terms.d, terms.i, terms.ff);
  });
}

}  // namespace attest::faults
