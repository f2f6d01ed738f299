#include "harness/diagnosis/similarity.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <iterator>
#include <map>
#include <string>
#include <utility>

#include "harness/core/agreement.hpp"
#include "harness/golden/reference.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/port/fault_port.hpp"

namespace attest {
namespace {

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

OutputMask difference(const OutputTable& outputs, const Answer& a, const Answer& b) {
  if (a.bytes == b.bytes) return 0;
  const Sample x = a.sample(), y = b.sample();
  OutputMask mask = 0, bit = 1;
  for (const Output& output : outputs) {
    if (differs(output, x, y)) mask |= bit;
    bit <<= 1;
  }
  return mask;
}

// A flag or a value that is not finite has no distance.
constexpr double most_misfit = 10;

double misfit_of(const Output& output, const Sample& a, const Sample& b) {
  if (!differs(output, a, b)) return 0;
  if (output.channel.type != ChannelType::f32) return most_misfit;
  const double x = float_of(output.channel, a), y = float_of(output.channel, b);
  const double distance = std::log2(1 + std::abs(x - y) / output.tolerance.at(y));
  return std::isfinite(distance) ? std::min(distance, most_misfit) : most_misfit;
}

double misfit(const OutputTable& outputs, const Outputs& a, const Outputs& b) {
  double sum = 0;
  for (std::size_t tick = 0; tick < a.size(); ++tick) {
    if (a[tick].bytes == b[tick].bytes) continue;
    const Sample x = a[tick].sample(), y = b[tick].sample();
    for (const Output& output : outputs) sum += misfit_of(output, x, y);
  }
  return sum;
}

Similarity similarity_of(const OutputTable& outputs, const Outputs& port, const Outputs& law,
                         const Outputs& fault, const std::vector<OutputMask>& port_deviates) {
  Similarity result;
  for (std::size_t tick = 0; tick < port.size(); ++tick) {
    const OutputMask parted = difference(outputs, port[tick], fault[tick]);
    const OutputMask fault_deviates = difference(outputs, fault[tick], law[tick]);
    result.matched += parted == 0 ? 1 : 0;
    const OutputMask same = port_deviates[tick] & fault_deviates & ~parted;
    result.same += static_cast<std::size_t>(std::popcount(same));
    result.other += static_cast<std::size_t>(std::popcount(fault_deviates & parted));
    result.deviating |= fault_deviates;
    result.parted |= parted;
    if (fault_deviates != 0) result.acts = std::min(result.acts, tick);
    if (parted != 0) result.parts = std::min(result.parts, tick);
  }
  result.misfit = misfit(outputs, port, fault);
  return result;
}

Similarity cannot_run(double misfit) {
  Similarity none;
  none.parted = ~OutputMask();
  none.parts = 0;
  none.misfit = misfit;
  return none;
}

bool same_bytes(const Outputs& a, const Outputs& b) {
  if (a.size() != b.size()) return false;
  return a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Answer)) == 0;
}

// The faults of the profile's law.
Hypothesis of_law(const Hypothesis& hypothesis, const std::string& profile) {
  Hypothesis faults;
  std::ranges::copy_if(hypothesis, std::back_inserter(faults), [&](const faults::Fault* fault) {
    return fault->profiles->is_of_law_of(profile);
  });
  return faults;
}

// Empty if the faults cannot run.
Outputs outputs_with(const Hypothesis& faults, Trace given, const ModuleUnderTest& subject) {
  if (faults.empty()) {
    const auto law = reference_outputs(subject, std::move(given));
    return law ? outputs_of(*law) : Outputs{};
  }
  return drive(*open_faults(faults), subject, given) ? Outputs{} : outputs_of(given);
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

Trace with_outputs(Trace trace, const Outputs& outputs) {
  for (std::size_t tick = 0; tick < outputs.size(); ++tick) {
    trace.samples[tick].copy_outputs(outputs[tick].sample());
  }
  return trace;
}

std::string hex_of(const Outputs& outputs) {
  constexpr const char* digits = "0123456789abcdef";
  std::string text;
  text.reserve(2 * outputs_size * outputs.size());
  for (const Answer& answer : outputs) {
    for (const std::byte byte : answer.bytes) {
      const auto value = std::to_integer<unsigned>(byte);
      text += digits[value >> 4];
      text += digits[value & 15];
    }
  }
  return text;
}

Outputs outputs_from(const std::string& hex) {
  const auto value = [](char digit) { return digit <= '9' ? digit - '0' : digit - 'a' + 10; };
  Outputs outputs(hex.size() / (2 * outputs_size));
  std::size_t at = 0;
  for (Answer& answer : outputs) {
    for (std::byte& byte : answer.bytes) {
      byte = static_cast<std::byte>(16 * value(hex[at]) + value(hex[at + 1]));
      at += 2;
    }
  }
  return outputs;
}

std::vector<Hypothesis> each_fault(const Hypothesis& base) {
  std::vector<Hypothesis> all;
  for (const faults::Fault* fault : faults::catalogue()) {
    all.push_back(base);
    all.back().push_back(fault);
  }
  return all;
}

std::size_t index_in_catalogue(const faults::Fault& fault) {
  const auto all = faults::catalogue();
  return static_cast<std::size_t>(std::find(all.begin(), all.end(), &fault) - all.begin());
}

FaultAnswers answers_of(std::span<const Hypothesis> hypotheses, const Trace& given,
                        const ModuleUnderTest& subject) {
  FaultAnswers answers;
  std::map<Hypothesis, std::size_t> known_faults;
  for (const Hypothesis& hypothesis : hypotheses) {
    const Hypothesis faults = of_law(hypothesis, subject.profile);
    const auto [place, is_new] = known_faults.try_emplace(faults);
    if (is_new) {
      Outputs outputs = outputs_with(faults, given, subject);
      const auto known = std::find_if(answers.distinct.begin(), answers.distinct.end(),
                                      [&](const Outputs& one) { return same_bytes(one, outputs); });
      place->second = static_cast<std::size_t>(known - answers.distinct.begin());
      if (known == answers.distinct.end()) answers.distinct.push_back(std::move(outputs));
    }
    answers.of_fault.push_back(place->second);
  }
  return answers;
}

VectorSimilarity distinct_similarity(const Outputs& port, const Outputs& law,
                                     std::span<const Outputs> distinct, Module module,
                                     const Tolerances& tolerances) {
  const OutputTable outputs = outputs_with(module, tolerances);
  VectorSimilarity result;
  result.ticks = port.size();
  std::vector<OutputMask> port_deviates;
  for (std::size_t tick = 0; tick < port.size(); ++tick) {
    port_deviates.push_back(difference(outputs, port[tick], law[tick]));
    result.deviating |= port_deviates.back();
  }
  result.misfit = misfit(outputs, port, law);
  for (const Outputs& fault : distinct) {
    const bool answered = fault.size() == port.size();
    result.similarities.push_back(answered ? similarity_of(outputs, port, law, fault, port_deviates)
                                           : cannot_run(result.misfit));
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
