#include "harness/report/progress.hpp"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <unistd.h>

#include "harness/report/terminal.hpp"
#include "harness/report/text.hpp"

namespace attest {
namespace {

constexpr std::size_t bar_width = 24;
constexpr const char* erase_line = "\r\x1b[K";

}  // namespace

Progress::Options Progress::on_stderr(bool quiet) {
  const char* term = std::getenv("TERM");
  const bool moves_cursor = term != nullptr && std::string_view(term) != "dumb";
  Options options;
  const bool is_terminal = moves_cursor && isatty(fileno(stderr)) != 0;
  if (!quiet) options.form = is_terminal ? Form::drawn : Form::lines;
  if (const int width = terminal_style(stderr).width; width > 0) options.width = width;
  return options;
}

void Progress::add(const VectorResult& result, Clock::time_point now) {
  add(result.plant_configuration ? flight : other, result.elapsed_s, fails_a_run(result.verdict),
      result.id(), now);
}

void Progress::add(bool failed, const std::string& latest, Clock::time_point now) {
  add(other, 1, failed, latest, now);
}

void Progress::add(KindOfResult kind_of_result, double cost, bool failed, const std::string& latest,
                   Clock::time_point now) {
  Kind& kind = kinds_[kind_of_result];
  kind.left -= std::min<std::size_t>(kind.left, 1);
  ++done_;
  if (failed) ++failed_;
  if (begin_ == Clock::time_point{}) {
    begin_ = now;
    done_before_ = done_;
    latest_ = now;
  } else {
    ++kind.done;
    kind.cost += cost;
  }
  if (options_.form == Form::drawn && (!drawn_ || now - latest_ >= redraw_interval)) {
    draw(latest, now);
    drawn_ = true;
    latest_ = now;
  }
  if (options_.form == Form::lines && now - latest_ >= line_interval) {
    write_line(now);
    latest_ = now;
  }
}

void Progress::write_line(Clock::time_point now) const {
  const std::string failed = failed_ > 0 ? fmt::format(", {} failed", failed_) : "";
  fmt::print(options_.stream, "attest: {} of {} done{}{}\n", done_, total_, failed, speed(now));
  std::fflush(options_.stream);
}

std::string Progress::speed(Clock::time_point now) const {
  const double seconds = std::chrono::duration<double>(now - begin_).count();
  if (done_ == done_before_ || !(seconds > 0) || done_ > total_) return "";
  const double rate = static_cast<double>(done_ - done_before_) / seconds;
  const std::optional<double> left = seconds_left(seconds);
  if (!left) return fmt::format(", {:.3g}/s", rate);
  constexpr double long_s = 120, short_s = 1;
  if (*left < short_s) return fmt::format(", {:.3g}/s, nearly done", rate);
  return *left > long_s ? fmt::format(", {:.3g}/s, {:.0f} min left", rate, *left / 60)
                        : fmt::format(", {:.3g}/s, {:.0f} s left", rate, *left);
}

std::optional<double> Progress::seconds_left(double seconds) const {
  double done = 0, left = 0;
  for (const Kind& kind : kinds_) {
    done += kind.cost;
    if (kind.left == 0) continue;
    if (kind.done == 0) return std::nullopt;
    left += static_cast<double>(kind.left) * kind.cost / static_cast<double>(kind.done);
  }
  if (!(done > 0)) return std::nullopt;
  return seconds * left / done;
}

void Progress::draw(const std::string& latest, Clock::time_point now) const {
  const std::size_t filled = total_ == 0 ? bar_width : std::min(done_, total_) * bar_width / total_;
  std::string line =
      fmt::format("[{:#<{}}{:-<{}}] {}/{}", "", filled, "", bar_width - filled, done_, total_);
  if (failed_ > 0) line += fmt::format(", {} failed", failed_);
  line += speed(now) + "  " + one_line(latest);
  // A line that wraps cannot be erased.
  line.resize(std::min(line.size(), static_cast<std::size_t>(std::max(options_.width - 1, 0))));
  std::fputs((erase_line + line).c_str(), options_.stream);
  std::fflush(options_.stream);
}

void Progress::finish() {
  if (!drawn_) return;
  std::fputs(erase_line, options_.stream);
  std::fflush(options_.stream);
  drawn_ = false;
}

}  // namespace attest
