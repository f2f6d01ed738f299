// Topics that the port never publishes. That is one mistake, which would hide the others: so it is
// one finding, and the outputs of the topic are not judged.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "harness/diagnosis/hunt_job.hpp"

namespace attest {

struct HuntSilence {
  std::size_t target;
  std::size_t topic;  // of output_topics()
  HuntInputs inputs;  // of a trial that shows it
  VectorResult failure;
  ChannelSet outputs;  // of the topic, that are not judged because of it
};

std::string_view topic_of(const HuntSilence& silence, const HuntedTarget& hunted);

// `hunted`, in which only this topic is judged.
HuntTarget only_topic(const HuntSilence& silence, const HuntedTarget& hunted);

// Of all trials so far.
class HuntSilences {
 public:
  explicit HuntSilences(std::uint64_t seed) : seed_(seed) {}

  // Brings HuntTarget::lacks of the targets up to date with a round. True if one changed: then the
  // round has to be made again. `targets` take turns in the trials.
  bool take(std::span<const HuntTrials> round, std::vector<HuntedTarget>& targets);

  const std::vector<HuntSilence>& found() const { return found_; }

 private:
  bool settle(std::size_t index, std::span<const HuntTrials> round,
              std::vector<HuntedTarget>& targets);
  bool takes_back(std::size_t index, const HuntTopicSet& published, HuntedTarget& hunted);

  std::uint64_t seed_;
  std::vector<HuntTopicSet> published_;  // of each target
  std::vector<HuntSilence> found_;
};

}  // namespace attest
