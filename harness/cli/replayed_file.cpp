#include "harness/cli/replayed_file.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/cli/outputs.hpp"
#include "harness/core/error_json.hpp"
#include "harness/host/file_format.hpp"
#include "harness/report/failure_text.hpp"
#include "harness/report/replay_document.hpp"
#include "harness/report/text.hpp"
#include "harness/verify/evaluate.hpp"
#include "harness/verify/evaluate_log.hpp"

namespace attest::cli {
namespace {

class FileReplay {
 public:
  FileReplay(const ReplayOptions& options, std::string file, Level level, bool is_quiet,
             PortHost& host)
      : options_(options),
        file_(std::move(file)),
        level_(level),
        is_quiet_(is_quiet),
        has_page_(!options.html.empty() && options.files.size() == 1),
        host_(host) {}

  Result<ReplayedFile> run() {
    const std::filesystem::path path = file_;  // gcc 14 warns of a reference from a temporary
    const FileFormat& format = format_of(path);
    if (!is_replayed(format)) return wrong_format(file_, format, is_replayed);
    const auto done = format.read_log != nullptr ? replay_log() : replay_trace();
    if (!done) return tl::unexpected(done.error());
    return std::move(found_);
  }

 private:
  Result<void> replay_trace() {
    auto recorded = recorded_in(file_, options_);
    if (!recorded) return tl::unexpected(recorded.error());
    found_.notes = recorded->notes();
    note_other_unit();
    return judge_trace(*recorded, recorded->subject());
  }

  // `attest sim` writes a flight of two units to two files.
  void note_other_unit() {
    const std::string other = attitude_unit_file(file_);
    const auto& files = options_.files;
    std::error_code unknown;
    if (!std::filesystem::exists(other, unknown)) return;
    if (std::find(files.begin(), files.end(), other) != files.end()) return;
    found_.notes.push_back(
        fmt::format("the attitude unit of this flight is in {}; to judge both units, give both "
                    "files",
                    other));
  }

  // A page shows the whole trace. Without one, the trace need not be in memory as a whole.
  Result<VectorResult> evaluated(TraceParts& trace, const ModuleUnderTest& subject) {
    const Tolerances tolerances(level_);
    if (!has_page_) return evaluate_parts(trace, subject, host_, tolerances);
    Trace whole, got;
    const auto read = trace.next_part(whole_trace, whole);
    if (!read) return tl::unexpected(read.error());
    VectorResult result = evaluate_trace(whole, subject, host_, tolerances, &got);
    keep_page({result.verdict},
              [&] { return trace_document(whole, got, result, options_.host.port); });
    return result;
  }

  Result<void> judge_trace(TraceParts& trace, const ModuleUnderTest& subject) {
    const auto evaluation = evaluated(trace, subject);
    if (!evaluation) return tl::unexpected(evaluation.error());
    const VectorResult& result = *evaluation;
    keep(result.verdict, json_of_trace(result, subject.module));
    const ChannelSet not_compared = channels_of(subject.module, "out/") & ~trace.present();
    if (result.verdict == Verdict::pass && is_quiet_ && not_compared.none()) return {};
    print_result(result, result.name, "tick", name_of(level_));
    if (not_compared.any()) {
      print("  not compared, because the trace does not have them: {}\n",
            fmt::join(names_of(not_compared), ", "));
    }
    if (result.verdict != Verdict::pass) print("{}", finding_text(result, level_));
    return {};
  }

  Result<void> replay_log() {
    const auto log = log_in(file_, options_, has_page_);
    if (!log) return tl::unexpected(log.error());
    found_.notes = log->notes;
    if (log->is_of_attest) note_other_unit();
    const LoggedUnit& first = log->units.front();
    found_.is_log = true;
    if (log->is_like_trace()) {
      Trace parameters;
      parameters.parameters = first.trace.parameters;
      for (const ParameterChange& change : parameters_of(options_, *log, first)) {
        override_parameter(change, parameters);
      }
      const auto ticks = ticks_of(first);
      ticks->set_parameters(std::move(parameters.parameters));
      return judge_trace(*ticks, {log->profile, first.module});
    }
    std::vector<LogResult> results;
    for (const LoggedUnit& unit : log->units) {
      if (auto judged = judge_unit(*log, unit, results); !judged) return judged;
    }
    keep_page(found_.verdicts,
              [&] { return log_document(*log, results, options_.log_limits, options_.host.port); });
    return {};
  }

  Result<void> judge_unit(const FlightLog& log, const LoggedUnit& unit,
                          std::vector<LogResult>& results) {
    const std::string& why_not = log.too_little.empty() ? log.no_profile : unit.not_judged;
    auto evaluated = why_not.empty() ? evaluate_log(unit, log.profile, host_, options_.log_limits,
                                                    parameters_of(options_, log, unit))
                                     : skipped(unit, why_not);
    if (!evaluated) return tl::unexpected(evaluated.error());
    const LogResult& found = results.emplace_back(*std::move(evaluated));
    keep(found.result.verdict, json_of_unit(log, unit, found, options_.log_limits));
    if (found.result.verdict == Verdict::pass && is_quiet_) return {};
    print_result(found.result, title_of(unit), found.single_steps ? "single step" : "tick", "log");
    print("{}", render_text(unit_table(unit, found, options_.log_limits), {}));
    return {};
  }

  static Result<LogResult> skipped(const LoggedUnit& unit, const std::string& reason) {
    LogResult found{result_for(unit.trace.source, "no profile"), {}, {}, {}, {}};
    found.result.verdict = Verdict::skip;
    found.result.reason = reason;
    return found;
  }

  // Makes the page only if it is wanted and has a result. Otherwise an old page is kept.
  template <typename MakeDocument>
  void keep_page(const std::vector<Verdict>& verdicts, MakeDocument make_document) {
    const bool any_result = std::any_of(verdicts.begin(), verdicts.end(), is_judged);
    if (has_page_ && any_result) found_.page = html_page(make_document());
  }

  void keep(Verdict verdict, const nlohmann::ordered_json& entry) {
    found_.verdicts.push_back(verdict);
    found_.entries.push_back(entry.dump());
  }

  template <typename... T>
  void print(fmt::format_string<T...> text, T&&... values) {
    fmt::format_to(std::back_inserter(found_.text), text, std::forward<T>(values)...);
  }

  // One line for each trace or unit, and a second one with the reason if it does not pass.
  // `step`: "tick" or "single step". `judged_by`: the level, or "log".
  void print_result(const VectorResult& result, const std::string& title, std::string_view step,
                    std::string_view judged_by) {
    print("{:<12}{}  {}", name_of(result.verdict), title, one_line(result.profile));
    if (result.ticks > 0) print("  {}, {}", counted(result.ticks, step), judged_by);
    if (result.verdict == Verdict::pass && result.tightest) {
      print(", tightest headroom {:.3g}x on {}", result.tightest->ratio,
            channels()[result.tightest->channel].name);
    }
    print("\n");
    if (result.verdict == Verdict::pass || result.reason.empty()) return;
    print("  {}\n", one_line(result.reason));
  }

  const ReplayOptions& options_;
  const std::string file_;
  Level level_;
  bool is_quiet_;
  bool has_page_;
  PortHost& host_;
  ReplayedFile found_;
};

}  // namespace

Result<ReplayedFile> ReplayJob::run(std::size_t) {
  const auto host = start_host(options_);
  if (!host) return tl::unexpected(host.error());
  const std::string& file = replay_.files[index_];
  auto found = FileReplay(replay_, file, level_, is_quiet_, **host).run();
  if (!found) {
    ReplayedFile unread;
    unread.error = found.error();
    found = std::move(unread);
  }
  found->index = index_;
  return found;
}

}  // namespace attest::cli

namespace attest {

using cli::ReplayedFile;

std::string Codec<ReplayedFile>::encode(const Result<ReplayedFile>& result) {
  return attest::encode(result.map([](const ReplayedFile& file) {
    nlohmann::json out = {{"index", file.index}, {"notes", file.notes},
                          {"text", file.text},   {"entries", file.entries},
                          {"page", file.page},   {"is_log", file.is_log}};
    out["verdicts"] = nlohmann::json::array();
    for (const Verdict verdict : file.verdicts) out["verdicts"].push_back(name_of(verdict));
    if (file.error) out["error"] = to_json(*file.error);
    return out;
  }));
}

Result<ReplayedFile> Codec<ReplayedFile>::decode(const std::string& text) {
  return attest::decode(text).and_then([](const nlohmann::json& in) -> Result<ReplayedFile> {
    ReplayedFile file;
    in.at("index").get_to(file.index);
    in.at("notes").get_to(file.notes);
    in.at("text").get_to(file.text);
    in.at("entries").get_to(file.entries);
    in.at("page").get_to(file.page);
    in.at("is_log").get_to(file.is_log);
    for (const auto& verdict : in.at("verdicts")) {
      file.verdicts.push_back(*parse_verdict(verdict.get<std::string>()));
    }
    if (!in.contains("error")) return file;
    auto error = error_from_json(in.at("error"));
    if (!error) return tl::unexpected(error.error());
    file.error = *std::move(error);
    return file;
  });
}

}  // namespace attest
