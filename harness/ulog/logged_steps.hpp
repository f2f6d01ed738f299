// Reads the steps of a unit of a log, each with its inputs and outputs, from the file.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "harness/ulog/paired_output.hpp"

namespace attest::ulog {

// A module of a log of which read_contents() counted the samples.
struct LoggedModule {
  ModuleContents log;
  Sample first;  // the sample before the first step
  LogRules rules;
  std::string file;
  std::vector<LogSeries*> outputs;  // those of `log` that the trace has
  // Of the whole log: LogSeries::size() and has_sample_times().
  std::size_t steps = 0;
  bool has_sample_times = false;
};

class LoggedSteps {
 public:
  // From the first step on. REQUIRES: `from` outlives this, and stays where it is; no other
  // LoggedSteps reads it. Errors, here and in next(): the file cannot be read, or has changed.
  static Result<LoggedSteps> open(LoggedModule& from);
  LoggedSteps(LoggedSteps&&) noexcept;
  LoggedSteps& operator=(LoggedSteps&&) = delete;
  ~LoggedSteps();

  // The next step, valid until the next call. REQUIRES: it was called less than LoggedModule::steps
  // times.
  Result<const PairedStep*> next();

  // Complete after the last step.
  const std::vector<PairedOutput>& outputs() const { return outputs_; }

 private:
  class Inputs;

  LoggedSteps(LoggedModule& from, SampleReader reader);
  Result<void> read_step();
  Result<void> read_outputs_before(std::size_t step);
  Result<void> read_to_end();

  LoggedModule& from_;
  SampleReader reader_;
  std::unique_ptr<Inputs> inputs_;
  std::vector<PairedOutput> outputs_;
  PairedSteps last_steps_;  // that were read, and are not yet returned
  std::size_t read_ = 0;    // steps
  PairedStep last_;         // the step returned last
};

}  // namespace attest::ulog
