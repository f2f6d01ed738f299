#include "harness/diagnosis/hunt_lacks.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "harness/casefile/baseline.hpp"
#include "harness/diagnosis/hunt_trace.hpp"
#include "harness/verify/declared_lacks.hpp"

namespace attest {
namespace {

// Starts with plain inputs, and brings back the original ones that use no feature which the port
// lacks.
class LeaveOut {
 public:
  LeaveOut(const Lacks& lacks, HuntInputs& inputs)
      : lacks_(lacks), original_(inputs), inputs_(inputs) {}

  void leave_out() {
    const Sample plain = baseline_sample(inputs_.subject.module);
    const auto topics = hunt_topics(inputs_.subject.module);
    for (const HuntTopic& topic : topics) hold(topic, plain, inputs_);
    std::erase_if(inputs_.parameters, [&](const ParameterChange& change) {
      return lacks_.constant(change.name) == nullptr;
    });
    for (const HuntTopic& topic : topics) bring_back(topic);
    bring_back_parameters();
  }

 private:
  // The topic has one value, from the first tick on.
  static void hold(const HuntTopic& topic, const Sample& value, HuntInputs& inputs) {
    for (HuntTick& tick : inputs.ticks) {
      topic.copy(value, tick.sample);
      tick.sample.in.updated &= ~topic.bit;
    }
    inputs.ticks.front().sample.in.updated |= topic.bit;
  }

  bool keeps(HuntInputs candidate) {
    if (uses_lacking(lacks_, candidate)) return false;
    inputs_ = std::move(candidate);
    return true;
  }

  void bring_back(const HuntTopic& topic) {
    HuntInputs candidate = inputs_;
    for (std::size_t i = 0; i < candidate.ticks.size(); ++i) {
      Sample& sample = candidate.ticks[i].sample;
      const Sample& from = original_.ticks[i].sample;
      topic.copy(from, sample);
      sample.in.updated = (sample.in.updated & ~topic.bit) | (from.in.updated & topic.bit);
    }
    if (keeps(candidate)) return;
    HuntInputs held = inputs_;
    hold(topic, candidate.ticks.back().sample, held);
    if (keeps(std::move(held))) return;
    // One field after the other. It has to be new at the first tick: before that it is 0.
    candidate.ticks.front().sample.in.updated |= topic.bit;
    for (const Channel* field : topic.fields) {
      HuntInputs with = inputs_;
      for (std::size_t i = 0; i < with.ticks.size(); ++i) {
        Sample& sample = with.ticks[i].sample;
        const Sample& from = candidate.ticks[i].sample;
        copy_value(*field, from, sample);
        sample.in.updated = (sample.in.updated & ~topic.bit) | (from.in.updated & topic.bit);
      }
      keeps(std::move(with));
    }
  }

  void bring_back_parameters() {
    std::set<std::string> names;
    for (const ParameterChange& change : original_.parameters) {
      if (lacks_.constant(change.name) == nullptr) names.insert(change.name);
    }
    for (const std::string& name : names) {
      HuntInputs candidate = inputs_;
      for (const ParameterChange& change : original_.parameters) {
        if (change.name == name) candidate.parameters.push_back(change);
      }
      std::ranges::stable_sort(candidate.parameters, {}, &ParameterChange::tick);
      if (keeps(candidate)) continue;
      std::erase_if(candidate.parameters, [&](const ParameterChange& change) {
        return change.name == name && change.tick > 0;
      });
      keeps(std::move(candidate));
    }
  }

  const Lacks& lacks_;
  const HuntInputs original_;
  HuntInputs& inputs_;
};

}  // namespace

bool uses_lacking(const Lacks& lacks, const HuntInputs& inputs) {
  if (lacks.features.none()) return false;
  return lacking_features(lacks, inputs_of(inputs), inputs.subject).any();
}

void leave_out_lacking(const Lacks& lacks, HuntInputs& inputs) {
  if (uses_lacking(lacks, inputs)) LeaveOut(lacks, inputs).leave_out();
}

}  // namespace attest
