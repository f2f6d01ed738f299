// Makes the content of a golden: the outputs of the reference for a case.
#pragma once

#include <functional>
#include <memory>

#include "harness/golden/golden.hpp"
#include "harness/golden/new_goldens.hpp"
#include "harness/host/port_process.hpp"
#include "harness/plant/vehicle_models.hpp"

namespace attest {

// The controller whose outputs become goldens: attest's own, or a port that a user's suite has as
// its reference. A port runs twice, in two processes of its own, because its outputs must be
// the same both times.
class GoldenSource {
 public:
  static GoldenSource own();
  // Errors: those of start_host().
  static Result<GoldenSource> of_port(const HostOptions& options);

  bool is_own() const { return again_ == nullptr; }
  std::optional<PortFault> drive(const ModuleUnderTest& subject, Trace& trace);

 private:
  explicit GoldenSource(std::unique_ptr<PortHost> host) : host_(std::move(host)) {}

  std::unique_ptr<PortHost> host_;
  std::unique_ptr<PortHost> again_;  // of a port: a second process
};

// The golden of a port keeps every tick. A port gets no goldens of flights, because flights are
// compared with attest's own law at each tick. If a port does not support the case, `left_out` is
// set. `stop` is called before each configuration. Errors: `stop` returned true; the reference
// fails, or gives other outputs the second time; those of reference_flight().
Result<MadeGolden> make_golden(const Case& the_case, GoldenSource& source,
                               VehicleModels& vehicle_models, const std::function<bool()>& stop);

// The golden that attest's own reference gives for one configuration of the case, for a case that
// has none in a file. `vehicle_model`: of a flight; else null. Errors: those of make_golden().
Result<Golden> golden_by_reference(const Case& the_case, const RunConfiguration& configuration,
                                   const VehicleModel* vehicle_model);

}  // namespace attest
