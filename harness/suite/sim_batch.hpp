// One flight at the desk: flown in a worker like any other, and written down.
#pragma once

#include <filesystem>
#include <memory>
#include <utility>

#include "harness/suite/batch.hpp"

namespace attest {

class SimBatch final : public Batch {
 public:
  // Writes the flown trace to `out`, also of a flight that ends early; `out` is not touched when
  // the port goes wrong.
  SimBatch(Case the_case, Setup setup, LoopTiming timing, std::shared_ptr<const Airframe> airframe,
           std::filesystem::path out)
      : case_(std::move(the_case)),
        setup_(std::move(setup)),
        timing_(std::move(timing)),
        airframe_(std::move(airframe)),
        out_(std::move(out)) {}

  std::size_t size() const override { return 1; }
  CaseResult identity(std::size_t i) const override;

  // The metrics have no reference here but the case's own bounds.
  Result<CaseResult> evaluate(std::size_t i, Port& port) override;

 private:
  Case case_;
  Setup setup_;
  LoopTiming timing_;
  std::shared_ptr<const Airframe> airframe_;
  std::filesystem::path out_;
};

}  // namespace attest
