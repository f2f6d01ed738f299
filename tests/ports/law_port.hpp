// The reference with some stages replaced, as a shared library: a port that computes in another
// way.
#pragma once

#include "controller/mc_att_control/mc_att_control_definition.hpp"
#include "controller/mc_att_control/unit_table.hpp"

// The reference's law with another attitude or rate loop.
template <typename Attitude, typename Rate = attest::mc_att_control::RateStages<float>>
struct LawWith {
  attest::mc_att_control::StepStages<float> step;
  Attitude attitude;
  Rate rate;
  attest::mc_att_control::RecoveryStages<float> recovery;
};

// Law has the members of mc_att_control::McAttControlLaw<float>.
#define ATTEST_LAW_PORT(name, Law)                                                            \
  extern "C" __attribute__((visibility("default"))) const attest_unit* attest_unit_v1(void) { \
    static constexpr attest_unit table = attest::mc_att_control::UnitTable<                   \
        attest::mc_att_control::McAttControl<float, Law>>::named(name, "1");                  \
    return &table;                                                                            \
  }
