#include "harness/compare/compare.hpp"

#include <charconv>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/cli/outputs.hpp"
#include "harness/cli/shared_arguments.hpp"
#include "harness/compare/compare_signals.hpp"
#include "harness/core/file.hpp"
#include "harness/host/file_format.hpp"
#include "harness/report/failure_text.hpp"
#include "harness/report/signals_document.hpp"
#include "harness/report/text.hpp"

namespace attest::cli {
namespace {

struct CompareOptions {
  std::string got, want;
  std::string level = "numeric";
  bool by_time = false;     // compare any signals, at equal times
  double others = 0;        // the tolerance of signals for which the level has none
  std::string shift = "0";  // us, or "auto"
  std::string html;
};

// The part of a result that the report shows; files have neither port nor case.
VectorResult as_result(const Comparison& comparison) {
  VectorResult result;
  result.ticks = comparison.ticks;
  result.deviating_ticks = comparison.deviating_ticks;
  result.first = comparison.first;
  result.worst = comparison.worst;
  return result;
}

// A text about outputs that only the first trace has; empty: there is no such output.
std::string not_compared(const ChannelSet& outputs, const std::string& want) {
  if (outputs.none()) return "";
  return fmt::format("; not compared, because {} does not have them: {}", want,
                     fmt::join(names_of(outputs), ", "));
}

// Other inputs make other outputs in the same law.
std::string different_inputs_text(const Comparison& comparison, const CompareOptions& options) {
  return fmt::format(
      "  inputs differ from tick {} on: {}\n"
      "  these traces do not tell whether the laws differ; record both with the same "
      "profile, inputs and parameters,\n"
      "  or judge a port with the inputs of one trace: attest replay {} --port PORT\n",
      comparison.inputs->tick, text_of(*comparison.inputs, options.got, options.want),
      shell_word(options.want));
}

int report_difference(const Comparison& comparison, const CompareOptions& options, Level level) {
  fmt::print("{} {} (got), {} (want){}\n", capitals(name_of(Conclusion::fail)), options.got,
             options.want, not_compared(comparison.only_got, options.want));
  if (!comparison.mismatch.empty()) fmt::print("  {}\n", comparison.mismatch);
  const bool differ =
      comparison.first && comparison.inputs && comparison.inputs->tick <= comparison.first->tick;
  if (differ) fmt::print("{}", different_inputs_text(comparison, options));
  fmt::print("{}", finding_text(as_result(comparison), level, differ));
  return exit_failed;
}

Result<TimedSignals> signals_in(const std::string& file) {
  auto signals = read_as<&FileFormat::read_signals>(file);
  if (!signals) return signals;
  for (const std::string& note : signals->notes) {
    fmt::print(stderr, "attest: note: {}: {}\n", file, note);
  }
  return signals;
}

bool is_trace(const std::string& file) { return format_of(file).open != nullptr; }

Result<std::unique_ptr<TraceParts>> trace_in(const std::string& file) {
  std::error_code unknown;
  if (!std::filesystem::is_fifo(file, unknown)) {
    return read_as<&FileFormat::open>(file, TraceNeed::outputs);
  }
  return fail_at(file, "is a pipe; write its content to a file first");
}

Result<Comparison> compare_ticks(const CompareOptions& options, const Tolerances& tolerances) {
  const auto got = trace_in(options.got);
  if (!got) return tl::unexpected(got.error());
  const auto want = trace_in(options.want);
  if (!want) return tl::unexpected(want.error());
  return compare(**got, **want, tolerances);
}

// The time of --shift; 0 for "auto".
Result<std::int64_t> parse_shift(const std::string& text) {
  if (text == "auto") return 0;
  std::int64_t us = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, us);
  if (error == std::errc::result_out_of_range || us < -latest_us || us > latest_us) {
    return fail(fmt::format("--shift {}: is beyond {} us", text, latest_us));
  }
  if (error == std::errc{} && rest == end) return us;
  return fail(fmt::format("--shift {}: write a whole number of microseconds, or auto", text));
}

// For "auto": the estimated time, or 0 if it cannot be estimated.
Result<std::int64_t> shift_of(const std::string& text, const TimedSignals& got,
                              const TimedSignals& want) {
  if (text != "auto") return parse_shift(text);
  const auto estimated = estimate_shift(got, want);
  return estimated ? estimated->us : 0;
}

std::string shift_text(std::int64_t shift_us) {
  return shift_us == 0 ? "" : fmt::format(", shifted by {} us", shift_us);
}

Result<void> check_compared(const CompareOptions& options, const SignalsComparison& found,
                            std::int64_t shift_us) {
  if (found.compared() > 0) return {};
  if (found.signals.empty()) {
    return fail(fmt::format("{} and {} have no signal in common", options.got, options.want));
  }
  return fail(
      fmt::format("{} and {} have no timestamp in common{}, so no sample was compared; "
                  "--shift US moves the first one",
                  options.got, options.want, shift_text(shift_us)));
}

int compare_by_time(const CompareOptions& options, Level level, bool quiet) {
  if (level == Level::events) return report_error({"--level events compares ticks, not times"});
  const auto got = signals_in(options.got);
  if (!got) return report_error(got.error());
  const auto want = signals_in(options.want);
  if (!want) return report_error(want.error());
  const auto shift = shift_of(options.shift, *got, *want);
  if (!shift) return report_error(shift.error());
  const auto found = compare_signals(*got, *want, Tolerances(level), options.others, *shift);
  if (const auto checked = check_compared(options, found, *shift); !checked) {
    return report_error(checked.error());
  }
  const Document document = comparison_document(found, *got, *want, *shift);
  if (!options.html.empty()) {
    const auto written = write_file(options.html, html_page(document));
    if (!written) return report_error(written.error());
  }
  if (!found.agrees() || !quiet) {
    const DocumentHead& head = document.head;
    fmt::print("{} {}: {}\n{}", capitals(head.word), head.title, head.sentence,
               render_text(document.tables.front(), {}));
  }
  return found.agrees() ? exit_ok : exit_failed;
}

int compare_command(const CompareOptions& options, const Globals& globals) {
  const auto level = parse_level(options.level);
  if (!level) return report_error(level.error());
  if (auto shift = parse_shift(options.shift); !shift) return report_error(shift.error());
  const auto checked =
      check_outputs({options.html}, {"", {options.got, options.want}}, globals.suite);
  if (!checked) return report_error(checked.error());
  if (options.by_time || !is_trace(options.got) || !is_trace(options.want)) {
    return compare_by_time(options, *level, globals.quiet);
  }
  if (!options.html.empty())
    return report_error({"--html is for a comparison by time; add --by-time"});
  const auto compared = compare_ticks(options, Tolerances(*level));
  if (!compared) return report_error(compared.error());
  const Comparison& comparison = *compared;
  if (!comparison.agrees()) return report_difference(comparison, options, *level);
  if (!globals.quiet || comparison.only_got.any()) {
    fmt::print("{} {} ticks, {}", capitals(name_of(Conclusion::pass)), comparison.ticks,
               name_of(*level));
    if (comparison.tightest) {
      fmt::print(", tightest headroom {:.3g}x on {} at tick {}", comparison.tightest->ratio,
                 channels()[comparison.tightest->channel].name, comparison.tightest->tick);
    }
    fmt::print("{}\n", not_compared(comparison.only_got, options.want));
  }
  return exit_ok;
}

}  // namespace

void add_compare(const CommandLine& line) {
  auto options = std::make_shared<CompareOptions>();
  const Command command = line.add("compare", "Compare two traces or flight logs");
  command.option("got", options->got, "The trace (CSV) or flight log (.ulg) to judge")
      .type("A")
      .required();
  command.option("want", options->want, "The trace or flight log with the expected values")
      .type("B")
      .required();
  command
      .option("--level", options->level, "How outputs are compared: `exact`, `numeric` or `events`")
      .type("LEVEL")
      .shows_default();
  command.flag("--by-time", options->by_time,
               "Compare all common signals at equal times; default: only if A or B is a log");
  command
      .option("--tolerance", options->others,
              "By time: allowed difference of signals other than the controller's outputs")
      .type("X")
      .at_least_zero()
      .shows_default();
  command
      .option("--shift", options->shift,
              "By time: move A earlier by this time [us] before the comparison; `auto` "
              "estimates it")
      .type("US")
      .shows_default();
  add_page(command, options->html,
           "a page with plots of the signals that differ; only for a comparison by time");
  command.examples({{"attest compare flown.csv reference.csv", "compare the outputs tick by tick"},
                    {"attest compare flown.ulg reference.csv --tolerance 1e-3",
                     "compare all common signals at equal times"}});
  command.runs(options, compare_command);
}

}  // namespace attest::cli
