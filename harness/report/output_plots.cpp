#include "harness/report/output_plots.hpp"

#include <optional>
#include <utility>

#include "harness/compare/tolerance.hpp"
#include "harness/trace/output_topics.hpp"

namespace attest {
namespace {

double seconds_from(const Trace& begin, std::uint64_t timestamp_us) {
  return 1e-6 * static_cast<double>(timestamp_us - begin.samples.front().in.timestamp);
}

}  // namespace

Plot plot_of_output(std::size_t index, const Trace& want, const Trace& got,
                    const char* name_of_want, const Trace* allowed) {
  const Channel& channel = channels()[index];
  const auto flag = channel.is_published_flag() ? std::nullopt : published_flag(channel);
  const auto is_published = [&](const Sample& sample) {
    return !flag || value_of(channels()[*flag], sample) != 0;
  };
  Plot plot{std::string(channel.name), std::string(unit_of(channel.quantity))};
  plot.series = {{name_of_want, {}, {}}, {"got", {}, {}}};
  plot.series[1].pattern = LinePattern::dashed;
  plot.least_span = 4 * Tolerances().of(index).absolute;
  if (channel.type != ChannelType::f32) plot.shape = PlotShape::steps;
  const auto add = [&](const Trace& trace, PlotSeries& series) {
    for (const Sample& sample : trace.samples) {
      if (!is_published(sample)) continue;
      series.x.push_back(seconds_from(want, sample.in.timestamp));
      series.y.push_back(static_cast<float>(value_of(channel, sample)));
    }
  };
  add(want, plot.series[0]);
  add(got, plot.series[1]);
  if (allowed == nullptr || channel.type != ChannelType::f32) return plot;
  PlotBand band{"allowed", plot.series[0].x, {}, {}};
  for (std::size_t tick = 0; tick < want.samples.size(); ++tick) {
    if (!is_published(want.samples[tick])) continue;
    const float middle = float_of(channel, want.samples[tick]);
    const float half = float_of(channel, allowed->samples[tick]);
    band.low.push_back(middle - half);
    band.high.push_back(middle + half);
  }
  plot.band = std::move(band);
  return plot;
}

PlotGroup plots_of_outputs(const Trace& want, const Trace& got, const char* name_of_want,
                           std::string caption) {
  PlotGroup group{std::move(caption), sample_time, {}};
  const ChannelSet outputs = channels_of(module_of(want.present), "out/") & want.present;
  for (std::size_t i = 0; i < channels().size(); ++i) {
    if (!outputs[i] || channels()[i].type != ChannelType::f32) continue;
    if (!published_flag(channels()[i])) continue;
    group.plots.push_back(plot_of_output(i, want, got, name_of_want));
  }
  return group;
}

PlotMark mark_of_first(const Deviation& first, const Trace& want) {
  return {seconds_from(want, first.timestamp_us), "first deviation"};
}

}  // namespace attest
