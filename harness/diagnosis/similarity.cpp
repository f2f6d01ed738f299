#include "harness/diagnosis/similarity.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>

#include "harness/compare/tolerance.hpp"
#include "harness/core/agreement.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/port/fault_port.hpp"

namespace attest {
namespace {

// A bit for each output of the module; 1 if the output differs.
using Mask = std::uint32_t;

struct Output {
  Channel channel;
  Tolerance tolerance;
};

using OutputTable = std::vector<Output>;

OutputTable outputs_with(Module module, const Tolerances& tolerances) {
  OutputTable outputs;
  const ChannelSet of_module = channels_of(module, "out/");
  for (std::size_t i = 0; i < channels().size(); ++i) {
    if (of_module[i]) outputs.push_back({channels()[i], tolerances.of(i)});
  }
  return outputs;
}

bool differs(const Output& output, const Sample& a, const Sample& b) {
  if (output.channel.type != ChannelType::f32) {
    return (value_of(output.channel, a) != 0) != (value_of(output.channel, b) != 0);
  }
  const float x = float_of(output.channel, a), y = float_of(output.channel, b);
  return !agree(x, y, output.tolerance.at(y));
}

Mask difference(const OutputTable& outputs, const Answer& a, const Answer& b) {
  if (a.bytes == b.bytes) return 0;
  const Sample x = a.sample(), y = b.sample();
  Mask mask = 0, bit = 1;
  for (const Output& output : outputs) {
    if (differs(output, x, y)) mask |= bit;
    bit <<= 1;
  }
  return mask;
}

Similarity similarity_of(const OutputTable& outputs, const Outputs& port, const Outputs& law,
                         const Outputs& fault, const std::vector<Mask>& port_deviates) {
  Similarity result;
  for (std::size_t tick = 0; tick < port.size(); ++tick) {
    const Mask parted = difference(outputs, port[tick], fault[tick]);
    result.matched += parted == 0 ? 1 : 0;
    const Mask fault_deviates = difference(outputs, fault[tick], law[tick]);
    result.deviates = result.deviates || fault_deviates != 0;
    const Mask in_both = port_deviates[tick] & fault_deviates & ~parted;
    const Mask in_either = port_deviates[tick] | fault_deviates;
    result.intersection += static_cast<std::size_t>(std::popcount(in_both));
    result.union_size += static_cast<std::size_t>(std::popcount(in_either));
  }
  return result;
}

bool same_bytes(const Outputs& a, const Outputs& b) {
  if (a.size() != b.size()) return false;
  return a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Answer)) == 0;
}

}  // namespace

Sample Answer::sample() const {
  Sample sample{};
  std::copy(bytes.begin(), bytes.end(), sample.outputs().begin());
  return sample;
}

Outputs outputs_of(const Trace& trace) {
  Outputs outputs;
  outputs.reserve(trace.samples.size());
  for (const Sample& sample : trace.samples) {
    std::copy_n(sample.outputs().begin(), outputs_size, outputs.emplace_back().bytes.begin());
  }
  return outputs;
}

FaultAnswers answers_of_faults(const Trace& given, const ModuleUnderTest& subject,
                               const faults::Fault* partner) {
  FaultAnswers answers;
  Trace answered = given;
  // Index of the outputs of faults of another law, which all have the same.
  std::optional<std::size_t> of_other_law;
  for (const faults::Fault* fault : faults::catalogue()) {
    const bool is_other = !fault->profiles->is_of_law_of(subject.profile);
    if (is_other && of_other_law) {
      answers.of_fault.push_back(*of_other_law);
      continue;
    }
    std::string ids(fault->id);
    if (partner != nullptr) ids += "+" + std::string(partner->id);
    const auto port = open_fault(ids);
    const bool done = !drive(**port, subject, answered);
    Outputs outputs = done ? outputs_of(answered) : Outputs{};
    const auto known = std::find_if(answers.distinct.begin(), answers.distinct.end(),
                                    [&](const Outputs& one) { return same_bytes(one, outputs); });
    answers.of_fault.push_back(static_cast<std::size_t>(known - answers.distinct.begin()));
    if (is_other) of_other_law = answers.of_fault.back();
    if (known == answers.distinct.end()) answers.distinct.push_back(std::move(outputs));
  }
  return answers;
}

VectorSimilarity distinct_similarity(const Outputs& port, const Outputs& law,
                                     std::span<const Outputs> distinct, Module module,
                                     const Tolerances& tolerances) {
  const OutputTable outputs = outputs_with(module, tolerances);
  VectorSimilarity result;
  result.ticks = port.size();
  std::vector<Mask> port_deviates;
  for (std::size_t tick = 0; tick < port.size(); ++tick) {
    port_deviates.push_back(difference(outputs, port[tick], law[tick]));
    result.deviates = result.deviates || port_deviates.back() != 0;
  }
  for (const Outputs& fault : distinct) {
    const bool answered = fault.size() == port.size();
    result.similarities.push_back(answered ? similarity_of(outputs, port, law, fault, port_deviates)
                                           : Similarity{});
  }
  return result;
}

VectorSimilarity of_each_fault(const VectorSimilarity& distinct, const FaultAnswers& faults) {
  VectorSimilarity result = distinct;
  result.similarities.clear();
  result.similarities.reserve(faults.of_fault.size());
  for (const std::size_t index : faults.of_fault) {
    result.similarities.push_back(distinct.similarities[index]);
  }
  return result;
}

VectorSimilarity similarity(const Outputs& port, const Outputs& law, const FaultAnswers& faults,
                            Module module, const Tolerances& tolerances) {
  return of_each_fault(distinct_similarity(port, law, faults.distinct, module, tolerances), faults);
}

}  // namespace attest
