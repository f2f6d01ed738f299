// The reference with stages of its own, as a shared library: a port that computes otherwise.
#pragma once

#include "controller/reference/mc_att_control_definition.hpp"
#include "controller/reference/unit_table.hpp"

// Law is as reference::ReferenceLaw<float>.
#define ATTEST_LAW_PORT(name, Law)                                                             \
  extern "C" __attribute__((visibility("default"))) const attest_unit* attest_unit_v1(void) {  \
    static constexpr attest_unit table =                                                       \
        attest::reference::UnitTable<attest::reference::McAttControl<float, Law>>::named(name, \
                                                                                         "1"); \
    return &table;                                                                             \
  }
