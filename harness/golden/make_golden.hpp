// The content of a golden: the outputs of the reference for a case.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "harness/golden/golden.hpp"
#include "harness/host/port_process.hpp"
#include "harness/plant/vehicle_models.hpp"

namespace attest {

// The controller whose outputs become goldens: attest's own, or a port that is the reference of a
// suite of its own. A port runs in processes of its own, and twice, because its outputs must be the
// same each time.
class Reference {
 public:
  static Reference own();
  // Errors: those of start_host().
  static Result<Reference> of_port(const HostOptions& options);

  bool is_own() const { return again_ == nullptr; }
  std::optional<PortFault> drive(const Subject& subject, Trace& trace);

 private:
  explicit Reference(std::unique_ptr<PortHost> host) : host_(std::move(host)) {}

  std::unique_ptr<PortHost> host_;
  std::unique_ptr<PortHost> again_;  // of a port: a second process
};

struct MadeGolden {
  std::vector<GoldenTrace> traces;  // one for each of the case's configurations, in that order
  std::vector<std::filesystem::path> vehicle_files;  // that its flights depend on
  std::string left_out = {};  // why the case has no golden of this reference; empty: it has one
};

// The golden of a port keeps every tick and has no branch alternatives, which only attest's own law
// can compute. It has no flights, which are compared with that law at each tick. `stop` is called
// before each configuration. Errors: `stop` returned true; the reference refuses the case, or gives
// other outputs the second time; those of reference_flight() and branch_alternatives().
Result<MadeGolden> make_golden(const Case& the_case, Reference& reference,
                               VehicleModels& vehicle_models, const std::function<bool()>& stop);

}  // namespace attest
