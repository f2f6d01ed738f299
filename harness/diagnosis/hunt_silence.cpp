#include "harness/diagnosis/hunt_silence.hpp"

#include <fmt/format.h>

#include "harness/trace/output_topics.hpp"

namespace attest {
namespace {

std::span<const OutputTopic> topics_of(const HuntedTarget& hunted) {
  return output_topics(hunted.target.subject.module);
}

ChannelSet outputs_of(std::size_t topic, const HuntedTarget& hunted) {
  return channels_of(hunted.target.subject.module,
                     fmt::format("out/{}.", topics_of(hunted)[topic].name));
}

// The first trial of the target that fails first in the topic. Its deviation cannot be explained by
// rounding.
const HuntTrial* trial_that_shows(std::size_t topic, std::size_t index, std::size_t targets,
                                  const ChannelSet& outputs, std::span<const HuntTrials> round) {
  for (const HuntTrials& trials : round) {
    for (const HuntTrial& trial : trials) {
      const bool is_silent = trial.due[topic] && !trial.published[topic];
      if (trial.number % targets != index || !is_silent) continue;
      if (trial.failure && trial.failure->first && outputs[trial.failure->first->channel]) {
        return &trial;
      }
    }
  }
  return nullptr;
}

}  // namespace

std::string_view topic_of(const HuntSilence& silence, const HuntedTarget& hunted) {
  return topics_of(hunted)[silence.topic].name;
}

HuntTarget only_topic(const HuntSilence& silence, const HuntedTarget& hunted) {
  HuntTarget target = hunted.target;
  target.lacks.outputs |= channels_of(target.subject.module, "out/");
  target.lacks.outputs &= ~silence.outputs;
  return target;
}

bool HuntSilences::take(std::span<const HuntTrials> round, std::vector<HuntedTarget>& targets) {
  published_.resize(targets.size());
  bool changes = false;
  for (std::size_t index = 0; index < targets.size(); ++index) {
    changes = settle(index, round, targets) || changes;
  }
  return changes;
}

bool HuntSilences::settle(std::size_t index, std::span<const HuntTrials> round,
                          std::vector<HuntedTarget>& targets) {
  HuntedTarget& hunted = targets[index];
  HuntTopicSet due;
  for (const HuntTrials& trials : round) {
    for (const HuntTrial& trial : trials) {
      if (trial.number % targets.size() != index) continue;
      due |= trial.due;
      published_[index] |= trial.published;
    }
  }
  bool changes = takes_back(index, published_[index], hunted);
  for (std::size_t topic = 0; topic < topics_of(hunted).size(); ++topic) {
    const std::size_t flag = topics_of(hunted)[topic].published;
    if (!due[topic] || published_[index][topic] || hunted.target.lacks.outputs[flag]) continue;
    const ChannelSet outputs = outputs_of(topic, hunted) & ~hunted.target.lacks.outputs;
    const HuntTrial* const trial = trial_that_shows(topic, index, targets.size(), outputs, round);
    if (trial == nullptr) continue;
    found_.push_back({index, topic, hunted.trial(seed_, trial->number, targets.size()),
                      *trial->failure, outputs});
    hunted.target.lacks.outputs |= outputs;
    changes = true;
  }
  return changes;
}

// A topic that was silent is published after all.
bool HuntSilences::takes_back(std::size_t index, const HuntTopicSet& published,
                              HuntedTarget& hunted) {
  return std::erase_if(found_, [&](const HuntSilence& silence) {
           if (silence.target != index || !published[silence.topic]) return false;
           hunted.target.lacks.outputs &= ~silence.outputs;
           return true;
         }) > 0;
}

}  // namespace attest
