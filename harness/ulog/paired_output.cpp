#include "harness/ulog/paired_output.hpp"

#include <algorithm>

#include "harness/ulog/own_topics.hpp"

namespace attest::ulog {
namespace {

// The step of this time; null if there is none. REQUIRES: the times of the steps do not decrease.
template <typename TimeOf>
PairedStep* find(PairedSteps& steps, std::uint64_t time, TimeOf time_of) {
  constexpr std::ptrdiff_t few = 4;  // it is nearly always one of the last
  const bool is_near = steps.end() - steps.begin() > few && time_of(*(steps.end() - few)) < time;
  const auto found = std::lower_bound(
      is_near ? steps.end() - few : steps.begin(), steps.end(), time,
      [&](const PairedStep& step, std::uint64_t wanted) { return time_of(step) < wanted; });
  return found == steps.end() || time_of(*found) != time ? nullptr : &*found;
}

}  // namespace

PairedOutput::PairedOutput(Module module, LogSeries& series, bool has_sample_times, LogRules rules)
    : series_(series),
      module_(module),
      rules_(rules),
      published_(channels()[*series.topic().is_new]),
      has_sample_times_(has_sample_times),
      logged_{series.name(), 0, 0} {}

void PairedOutput::pair_until(std::optional<std::uint64_t> end, PairedSteps& steps) {
  while (next_row_ < series_.size() && (!end || series_.time(next_row_) < *end)) {
    pair(next_row_++, steps);
  }
  series_.forget_before(next_row_);
}

void PairedOutput::pair(std::size_t row, PairedSteps& steps) {
  if (is_of_others(steps)) {
    const bool is_known = !steps.empty() && !flies_by_rotors(module_, steps.back().sample);
    logged_.other_wings += is_known ? 1 : 0;
    return;
  }
  ++logged_.samples;
  PairedStep* const step = step_of(row, steps);
  if (step == nullptr || value_of(published_, step->sample) != 0) return;
  series_.copy(row, step->sample);
  set_value(published_, step->sample, 1);
  ++logged_.paired;
}

// Whether another module published the sample, because this unit does not publish the topic in the
// mode of the last step. Also true before the log's first step.
bool PairedOutput::is_of_others(const PairedSteps& steps) const {
  if (rules_ != LogRules::cascade) return false;
  return steps.empty() || !publishes(module_, series_.name(), steps.back().sample);
}

// The step that published the output; null if it is not known.
PairedStep* PairedOutput::step_of(std::size_t row, PairedSteps& steps) const {
  if (steps.empty()) return nullptr;
  const auto sampled = series_.sample_time(row);
  if (sampled && has_sample_times_) {
    return find(steps, *sampled, [](const PairedStep& step) { return *step.sample_time; });
  }
  const auto time_of = [](const PairedStep& step) { return step.sample.in.timestamp; };
  PairedStep* const step = sampled ? find(steps, *sampled, time_of) : &steps.back();
  const bool is_late = step != nullptr && rules_ == LogRules::cascade &&
                       series_.time(row) - time_of(*step) > latest_answer_us;
  return is_late ? nullptr : step;
}

void PairedOutput::repeat(const Sample& before, Sample& sample) const {
  if (value_of(published_, sample) != 0) return;
  series_.copy_fields(before, sample);
}

}  // namespace attest::ulog
