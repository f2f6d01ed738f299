// What one worker process does: some tasks in a row, each with a verdict of its own.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/port/port.hpp"
#include "harness/run/golden.hpp"
#include "harness/suite/verdict.hpp"

namespace attest {

class Batch {
 public:
  virtual ~Batch() = default;

  virtual std::size_t size() const = 0;

  // What task i is called, for the verdict on a port that did not live to give one.
  virtual CaseResult identity(std::size_t i) const = 0;

  // Before the first task of a process. An error is one for all tasks, which are then left out.
  virtual Result<void> open() { return {}; }

  // REQUIRES: open() went well.
  virtual Result<CaseResult> evaluate(std::size_t i, Port& port) = 0;
};

// A case at some of its rates, ascending.
class CaseBatch final : public Batch {
 public:
  CaseBatch(Case the_case, std::vector<Rate> rates, std::filesystem::path golden_root, Level level)
      : case_(std::move(the_case)),
        rates_(std::move(rates)),
        golden_root_(std::move(golden_root)),
        level_(level) {}

  std::size_t size() const override { return rates_.size(); }
  CaseResult identity(std::size_t i) const override;
  Result<void> open() override;
  Result<CaseResult> evaluate(std::size_t i, Port& port) override;

 private:
  Case case_;
  std::vector<Rate> rates_;
  std::filesystem::path golden_root_;
  Level level_;
  std::optional<Golden> golden_;
};

// A recorded trace.
class TraceBatch final : public Batch {
 public:
  TraceBatch(Trace recorded, std::string profile, Tolerances tolerances)
      : recorded_(std::move(recorded)), profile_(std::move(profile)), tolerances_(tolerances) {}

  std::size_t size() const override { return 1; }
  CaseResult identity(std::size_t i) const override;
  Result<CaseResult> evaluate(std::size_t i, Port& port) override;

 private:
  Trace recorded_;
  std::string profile_;
  Tolerances tolerances_;
};

}  // namespace attest
