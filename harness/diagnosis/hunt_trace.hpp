// The trace of a trial, with the outputs of the reference, part by part. While it is made, it notes
// what the reference met: the guidance of a hunt.
#pragma once

#include <bitset>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "harness/diagnosis/hunt_inputs.hpp"
#include "harness/golden/margins.hpp"
#include "harness/host/port_host.hpp"
#include "harness/trace/trace_parts.hpp"

namespace attest {

// What the reference met in a trial, as numbers: how near it came to each decision, which topics
// it published in one step, and the signs of its outputs.
inline constexpr std::size_t feature_limit = 4096;
using HuntFeatures = std::bitset<feature_limit>;

// Output topics of a module, by their index in output_topics().
using HuntTopicSet = std::bitset<8>;
HuntTopicSet published_in(const Trace& trace);

class HuntTrace final : public TraceParts {
 public:
  // Without `meets`, only the outputs are made. REQUIRES: `inputs` outlives this.
  explicit HuntTrace(const HuntInputs& inputs, HuntFeatures* meets = nullptr);

  const std::string& file() const override { return source_; }
  const ChannelSet& present() const override { return present_; }
  // Errors: the reference has no such module, or fails.
  Result<void> next_part(std::size_t most, Trace& part) override;
  Result<void> rewind() override;

  // The topics that the reference has published so far.
  const HuntTopicSet& published() const { return published_; }

 private:
  friend Trace inputs_of(const HuntInputs& inputs);
  void add_tick(Trace& part);
  void note(const Trace& part);

  const HuntInputs& inputs_;
  HuntFeatures* meets_;
  std::string source_ = "hunt";
  ChannelSet present_;
  std::vector<const Channel*> outputs_;
  std::vector<const Channel*> flags_;  // of outputs_: bytes
  bool is_unit_;
  std::unique_ptr<PortHost> reference_;
  std::unique_ptr<MarginMeter> meter_;
  // The next tick: of the inputs, of the quiet ticks after it, of the trace, and its period.
  std::size_t tick_ = 0, quiet_ = 0, step_ = 0;
  std::int64_t period_ = 0;
  std::size_t change_ = 0;
  std::size_t last_pattern_ = 0;  // of the topics published in the last step
  Sample held_;
  HuntTopicSet published_;
  bool is_finished_ = false;
};

// The ticks without the quiet ones, without outputs.
Trace inputs_of(const HuntInputs& inputs);

// All ticks, with the outputs of the reference.
Result<Trace> whole_trace_of(const HuntInputs& inputs);

// The inputs up to the tick that meets the last of `features`. REQUIRES: the trial meets them.
HuntInputs begin_that_meets(const HuntFeatures& features, const HuntInputs& inputs);

// "the reference came nearer to a decision: tilt limit, yaw limit", for the reader of a case.
std::string text_of(const HuntFeatures& features);

// The index in `inputs.ticks` of a tick of the trace.
std::size_t tick_of_step(const HuntInputs& inputs, std::size_t step);

}  // namespace attest
