// Makes logs of a unit for tests.
#pragma once

#include <initializer_list>

#include <gtest/gtest.h>

#include "harness/host/in_process_host.hpp"
#include "harness/port/builtin.hpp"
#include "harness/ulog/flight_log.hpp"

namespace attest {

// A log with every step of a unit, as yet without a tick.
inline LoggedUnit log_of(Module module, const char* step_topic) {
  LoggedUnit log;
  log.module = module;
  log.step_topic = step_topic;
  log.has_every_step = true;
  log.trace.source = "flight.ulg";
  log.trace.present = channels_of(module);
  return log;
}

// Adds the reference's outputs, as logged outputs of these topics.
inline void add_outputs(const char* law, std::initializer_list<const char*> topics,
                        LoggedUnit& log) {
  const std::size_t ticks = log.trace.samples.size();
  log.setpoints.assign(ticks, {Known::all, 0});
  InProcessHost reference(open_builtin());
  EXPECT_FALSE(reference.drive({law, log.module}, log.trace));
  for (const char* topic : topics) log.outputs.push_back({topic, ticks, ticks});
}

}  // namespace attest
