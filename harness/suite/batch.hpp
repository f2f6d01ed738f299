// What one worker process does: some tasks in a row, each with a verdict of its own.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/plant/fleet.hpp"
#include "harness/port/port.hpp"
#include "harness/run/golden.hpp"
#include "harness/run/open_loop.hpp"
#include "harness/run/timing_file.hpp"
#include "harness/suite/select.hpp"
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

  // Of a task that has parts, how many at most: what the process says cannot give a task more time
  // than a limit for each of them. 0: a task has one limit.
  virtual std::size_t most_parts() const { return 0; }

  // Calls `begins` before each part of a task; the time limit then starts anew.
  void when_part_begins(std::function<void()> begins) { part_begins_ = std::move(begins); }

 protected:
  // For a task that runs many vectors: the time limit is that of one.
  void begin_part() const { part_begins_(); }

 private:
  std::function<void()> part_begins_ = [] {};
};

// A case in some of its setups: any of an open-loop case, or those of one flyer.
class CaseBatch final : public Batch {
 public:
  // `airframe` is the flyer's; null for open loop.
  CaseBatch(Case the_case, std::vector<Setup> setups, std::shared_ptr<const Airframe> airframe,
            std::filesystem::path golden_root, Level level)
      : case_(std::move(the_case)),
        setups_(std::move(setups)),
        airframe_(std::move(airframe)),
        golden_root_(std::move(golden_root)),
        level_(level) {}

  std::size_t size() const override { return setups_.size(); }
  CaseResult identity(std::size_t i) const override;
  Result<void> open() override;
  Result<CaseResult> evaluate(std::size_t i, Port& port) override;

 private:
  Case case_;
  std::vector<Setup> setups_;
  std::shared_ptr<const Airframe> airframe_;
  std::filesystem::path golden_root_;
  Level level_;
  std::optional<Golden> golden_;
};

// A flight at recorded times.
class TimedBatch final : public Batch {
 public:
  TimedBatch(Case the_case, TimingFile timing, std::shared_ptr<const Airframe> airframe)
      : case_(std::move(the_case)), timing_(std::move(timing)), airframe_(std::move(airframe)) {}

  std::size_t size() const override { return 1; }
  CaseResult identity(std::size_t i) const override;
  Result<CaseResult> evaluate(std::size_t i, Port& port) override;

 private:
  Case case_;
  TimingFile timing_;
  std::shared_ptr<const Airframe> airframe_;
};

// The batches of the cases that were selected, in order: one for an open-loop case, one a flyer for
// a flight, so that long flights are shared among the workers. Errors: a vehicle that cannot be
// loaded.
Result<std::vector<std::unique_ptr<Batch>>> make_batches(const std::vector<SelectedCase>& cases,
                                                         const std::filesystem::path& golden_root,
                                                         Fleet& fleet, Level level);

// A recorded trace.
class TraceBatch final : public Batch {
 public:
  TraceBatch(Trace recorded, Subject subject, Tolerances tolerances)
      : recorded_(std::move(recorded)), subject_(std::move(subject)), tolerances_(tolerances) {}

  std::size_t size() const override { return 1; }
  CaseResult identity(std::size_t i) const override;
  Result<CaseResult> evaluate(std::size_t i, Port& port) override;

 private:
  Trace recorded_;
  Subject subject_;
  Tolerances tolerances_;
};

}  // namespace attest
