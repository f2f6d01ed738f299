#include "harness/report/time_text.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/core/version.hpp"
#include "harness/report/stress_text.hpp"
#include "harness/report/text.hpp"
#include "harness/suite/time_batch.hpp"

namespace attest {
namespace {

constexpr std::size_t slowest_told = 5;

double figure_of(const CaseResult& result, const char* name) {
  const auto found = result.figures.find(name);
  return found == result.figures.end() ? 0 : found->second;
}

std::string time_of(const CaseResult& result, const char* name) {
  return human_time(Nanoseconds(static_cast<std::int64_t>(figure_of(result, name))));
}

std::string slowest(const TimeRun& run) {
  std::vector<const CaseResult*> order;
  for (const CaseResult& result : run.results) {
    if (&result != &run.all() && result.figures.contains(figure::max)) order.push_back(&result);
  }
  std::stable_sort(order.begin(), order.end(), [](const CaseResult* a, const CaseResult* b) {
    return figure_of(*a, figure::max) > figure_of(*b, figure::max);
  });
  std::string out;
  for (std::size_t i = 0; i < std::min(order.size(), slowest_told); ++i) {
    out += fmt::format("  {:>9}  {} tick {:.0f}\n", time_of(*order[i], figure::max),
                       one_line(order[i]->id()), figure_of(*order[i], figure::worst_tick));
  }
  return out;
}

// Of all vectors, also of those before a crash.
std::string stack(const TimeRun& run) {
  const CaseResult* most = nullptr;
  for (const CaseResult& result : run.results) {
    if (&result == &run.all() || !result.figures.contains(figure::stack)) continue;
    if (!most || figure_of(result, figure::stack) > figure_of(*most, figure::stack)) most = &result;
  }
  if (!most) return "";
  return fmt::format("stack of a step: at most {:.0f} bytes ({})\n",
                     figure_of(*most, figure::stack), one_line(most->id()));
}

std::string instructions(std::vector<std::uint64_t> calls) {
  if (calls.empty()) return "";
  const auto worst = std::max_element(calls.begin(), calls.end()) - calls.begin();
  const std::uint64_t most = calls[static_cast<std::size_t>(worst)];
  std::sort(calls.begin(), calls.end());
  return fmt::format(
      "instructions of the slowest vector's steps, the same on every run: least {}, "
      "median {}, most {} (tick {})\n",
      calls.front(), calls[calls.size() / 2], most, worst);
}

nlohmann::ordered_json figures_json(const CaseResult& result) {
  auto out = nlohmann::ordered_json::object();  // of what went wrong: none
  for (const auto& [name, value] : result.figures) out[name] = value;
  return out;
}

}  // namespace

bool TimeRun::crashed() const {
  return std::any_of(results.begin(), results.end(), [](const CaseResult& result) {
    return result.verdict == Verdict::crash || result.verdict == Verdict::timeout;
  });
}

std::string what_went_wrong(const TimeRun& run) {
  std::string out, last_reason;
  std::size_t repeated = 0;
  const auto say_repeated = [&] {
    if (repeated > 0) out += fmt::format("  and {} more with the same reason\n", repeated);
    repeated = 0;
  };
  for (const CaseResult& result : run.results) {
    if (!fails_a_run(result.verdict)) continue;
    if (result.reason == last_reason) {
      ++repeated;
      continue;
    }
    say_repeated();
    last_reason = result.reason;
    out += fmt::format("{} {}: {}\n", one_line(result.id()), name_of(result.verdict),
                       one_line(result.reason));
  }
  say_repeated();
  return out;
}

std::string render_times(const TimeRun& run) {
  const CaseResult& all = run.all();
  const std::size_t vectors = run.results.size() - 1;
  std::string out = fmt::format(
      "{}: {:.0f} steps of {}, each the quickest of {}; reading the clock "
      "({}) is taken off\n",
      one_line(run.port), figure_of(all, figure::steps), counted(vectors, "vector"), run.repeats,
      time_of(all, figure::clock));
  const char* const columns[] = {figure::min, figure::median, figure::p90,
                                 figure::p99, figure::p999,   figure::max};
  out += fmt::format("  {:>10}{:>10}{:>10}{:>10}{:>10}{:>10}\n  ", "min", "median", "p90", "p99",
                     "p99.9", "max");
  for (const char* column : columns) out += fmt::format("{:>10}", time_of(all, column));
  out += "\nslowest steps:\n" + slowest(run) + stack(run) + instructions(run.instructions);
  out += what_went_wrong(run);
  if (run.crashed()) {
    out += "a crash takes the figures with it: those above are of what ran after the last one\n";
  }
  if (run.budget_us) {
    out += fmt::format("{:.0f} of {:.0f} steps took longer than {:g} us\n",
                       figure_of(all, figure::over_budget), figure_of(all, figure::steps),
                       *run.budget_us);
  }
  return out;
}

std::string time_json(const TimeRun& run) {
  nlohmann::ordered_json out = {{"schema", "attest-time-1"},
                                {"attest_version", version},
                                {"port", run.port},
                                {"repeats", run.repeats},
                                {"budget_us", nullptr},
                                {"all", figures_json(run.all())},
                                {"slowest", run.all().reason},
                                {"instructions", run.instructions},
                                {"vectors", nlohmann::json::array()}};
  if (run.budget_us) out["budget_us"] = *run.budget_us;
  for (const CaseResult& result : run.results) {
    if (&result == &run.all()) continue;
    nlohmann::ordered_json vector = {{"id", result.id()}, {"verdict", name_of(result.verdict)}};
    vector.update(figures_json(result));
    out["vectors"].push_back(std::move(vector));
  }
  return out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace attest
