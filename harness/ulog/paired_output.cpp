#include "harness/ulog/paired_output.hpp"

#include <algorithm>

#include "harness/ulog/own_topics.hpp"

namespace attest::ulog {

PairedOutput::PairedOutput(const ModuleContents& log, const LogSeries& series, LogRules rules)
    : series_(series),
      steps_(log.steps()),
      module_(log.module()),
      rules_(rules),
      published_(channels()[*series.topic().is_new]),
      rows_(steps_.size()),
      logged_{series.name(), 0, 0} {
  const auto& sampled = steps_.sample_times();
  has_sample_times_ =
      sampled.size() == steps_.size() && std::is_sorted(sampled.begin(), sampled.end());
}

void PairedOutput::pair_until(std::size_t next_tick, const Sample* step) {
  const bool has_next = next_tick < steps_.size();
  while (next_row_ < series_.size() &&
         (!has_next || series_.time(next_row_) < steps_.time(next_tick))) {
    pair(next_row_++, step);
  }
}

void PairedOutput::pair(std::size_t row, const Sample* step) {
  const auto tick = tick_of(row);
  if (is_of_others(step)) return;
  ++logged_.samples;
  if (!tick || rows_[*tick] > 0) return;
  rows_[*tick] = static_cast<std::uint32_t>(row + 1);
  ++logged_.paired;
}

// Whether another module published the sample, because this unit does not publish the topic in the
// mode of that step. Also true before the log's first step.
bool PairedOutput::is_of_others(const Sample* step) const {
  if (rules_ != LogRules::cascade) return false;
  return step == nullptr || !publishes(module_, series_.name(), *step);
}

// The tick of the step that published the output; empty if it is not known.
std::optional<std::size_t> PairedOutput::tick_of(std::size_t row) const {
  const auto sampled = series_.sample_time(row);
  if (sampled && has_sample_times_) return tick_sampled_at(*sampled);
  const auto after = steps_.first_after(sampled ? *sampled : series_.time(row));
  if (after == 0) return std::nullopt;
  if (sampled && steps_.time(after - 1) != *sampled) return std::nullopt;
  const bool is_late =
      rules_ == LogRules::cascade && series_.time(row) - steps_.time(after - 1) > latest_answer_us;
  return is_late ? std::nullopt : std::optional(after - 1);
}

std::optional<std::size_t> PairedOutput::tick_sampled_at(std::uint64_t time) const {
  const auto& all = steps_.sample_times();
  const auto found = std::lower_bound(all.begin(), all.end(), time);
  if (found == all.end() || *found != time) return std::nullopt;
  return static_cast<std::size_t>(found - all.begin());
}

void PairedOutput::add_to(std::size_t tick, const Sample& before, Sample& sample) const {
  if (rows_[tick] > 0) {
    series_.copy(rows_[tick] - 1, sample);
    set_value(published_, sample, 1);
  } else if (tick > 0) {
    for (const LogField& field : series_.topic().fields) {
      copy_value(channels()[field.channel], before, sample);
    }
  }
}

}  // namespace attest::ulog
