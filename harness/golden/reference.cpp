#include "harness/golden/reference.hpp"

#include <fmt/format.h>

#include "harness/host/in_process_host.hpp"
#include "harness/loop/unit_driver.hpp"
#include "harness/port/builtin.hpp"

namespace attest {

std::unique_ptr<PortHost> open_reference(const Course& course, Precision precision) {
  const bool in_double = precision == Precision::binary64;
  return std::make_unique<InProcessHost>(in_double ? open_builtin_in_double() : open_builtin(),
                                         std::nullopt, course);
}

Result<Trace> reference_outputs(const ModuleUnderTest& subject, Trace inputs) {
  ModuleUnderTest alone = subject;
  alone.instances = Instances::one;
  if (const auto fault = drive(*open_builtin(), alone, inputs)) {
    return fail_at(inputs.source, fmt::format("the reference: {}", fault->what));
  }
  return inputs;
}

Result<void> for_each_reference_output(const ModuleUnderTest& subject, const Trace& trace,
                                       const OnTick& on_tick) {
  const auto port = open_builtin();
  const auto unit = port->create_unit(subject.module, subject.profile, "");
  if (!unit) return fail(fmt::format("the reference has no profile `{}`", subject.profile));
  UnitDriver law(*unit, subject.module);
  PendingChanges changes(trace.parameters);
  for (std::size_t tick = 0; tick < trace.samples.size(); ++tick) {
    const auto at_tick = changes.take_until(tick);
    Sample right = trace.samples[tick];
    if (const auto fault = law.step(tick, at_tick, right)) {
      return fail(fmt::format("the reference, at tick {}: {}", tick, fault->what));
    }
    on_tick(tick, at_tick, trace.samples[tick], right);
  }
  return {};
}

}  // namespace attest
