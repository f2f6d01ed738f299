// The rule of attest_unit.h for topics: in a step that does not publish a topic, its other fields
// keep the values last published.
#pragma once

#include "controller/attest_unit.h"

namespace attest {

// Gives the topics of `now` that are not published their values in `before`, the outputs of the
// step before.
inline void keep_unpublished(const attest_outputs& before, attest_outputs& now) {
  const auto keep = [](const auto& topic_before, auto& topic) {
    if (topic.published != 0) return;
    topic = topic_before;
    topic.published = 0;
  };
  keep(before.vehicle_rates_setpoint, now.vehicle_rates_setpoint);
  keep(before.actuator_controls_0, now.actuator_controls_0);
  keep(before.mc_att_ctrl_status, now.mc_att_ctrl_status);
}

}  // namespace attest
