#include "harness/report/log_text.hpp"

#include <fmt/format.h>

#include "harness/report/failure_text.hpp"

namespace attest {
namespace {

std::string part_text(std::size_t count, const TopicAgreement& topic, const std::string& what) {
  const double part = static_cast<double>(count) / static_cast<double>(topic.paired);
  return fmt::format("    {:6} {:5.1f}%  {}\n", count, 100 * part, what);
}

std::string deviations_text(const TopicAgreement& topic, const LogLimits& limits) {
  std::string text =
      fmt::format("    off by: median {:.3g}, 90% up to {:.3g}, 99% up to {:.3g}, largest {:.3g}\n",
                  topic.median, topic.p90, topic.p99, topic.largest);
  text += part_text(topic.within, topic, fmt::format("within {:g}", limits.within));
  if (topic.within == topic.paired) return text;
  text += part_text(topic.between_samples, topic,
                    "explained: port and log are within the reference's values at this and the two "
                    "neighbouring samples");
  text += part_text(topic.unexplained(), topic, "not explained");
  if (topic.missing > 0) text += part_text(topic.missing, topic, "not published by the port");
  if (topic.non_finite > 0)
    text += part_text(topic.non_finite, topic, "NaN or infinity where the log has a number");
  return text;
}

std::string first_text(const LoggedPair& pair) {
  const Channel& channel = channels()[pair.channel];
  return fmt::format(
      "    first one not explained: tick {}, {:.3f} s after tick 0, in {}\n"
      "      got    {}\n      logged {}\n",
      pair.tick, pair.after_s, channel_with_unit(channel), value_text(channel, pair.got),
      value_text(channel, pair.logged));
}

// `said`: the reason of the verdict, which is not repeated.
std::string topic_text(const LoggedUnit& log, const TopicAgreement& topic,
                       const LoggedOutput& logged, const LogLimits& limits,
                       const std::string& said) {
  std::string text = fmt::format("  {}: {} of {} logged samples paired with a {}\n", topic.topic,
                                 logged.paired, logged.samples, log.step_topic);
  if (topic.left_out > 0) {
    text += fmt::format("    {} of them left out: the log does not have all that they depend on\n",
                        topic.left_out);
  }
  if (topic.paired > 0) text += deviations_text(topic, limits);
  if (!topic.not_judged.empty()) {
    const bool is_said = topic.not_judged == said;
    text += is_said ? "    not judged\n" : fmt::format("    not judged: {}\n", topic.not_judged);
  } else if (topic.first_unexplained) {
    text += first_text(*topic.first_unexplained);
  }
  return text;
}

}  // namespace

std::string title_of(const LoggedUnit& log) {
  if (log.module == Module::mc_att_control) return log.trace.source;
  return fmt::format("{}: {}", log.trace.source, info_of(log.module).title);
}

std::string log_text(const LoggedUnit& log, const LogResult& result, const LogLimits& limits) {
  std::string text;
  for (std::size_t i = 0; i < result.topics.size(); ++i) {
    text += topic_text(log, result.topics[i], log.outputs[i], limits, result.result.reason);
  }
  return text;
}

}  // namespace attest
