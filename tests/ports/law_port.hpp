// The reference with some stages replaced, as a shared library: a port that computes in another
// way.
#pragma once

#include "controller/reference/mc_att_control_definition.hpp"
#include "controller/reference/unit_table.hpp"

// The reference's law with another attitude or rate loop.
template <typename Attitude, typename Rate = attest::reference::RateStages<float>>
struct LawWith {
  attest::reference::StepStages<float> step;
  Attitude attitude;
  Rate rate;
  attest::reference::RecoveryStages<float> recovery;
};

// Law has the members of reference::ReferenceLaw<float>.
#define ATTEST_LAW_PORT(name, Law)                                                             \
  extern "C" __attribute__((visibility("default"))) const attest_unit* attest_unit_v1(void) {  \
    static constexpr attest_unit table =                                                       \
        attest::reference::UnitTable<attest::reference::McAttControl<float, Law>>::named(name, \
                                                                                         "1"); \
    return &table;                                                                             \
  }
