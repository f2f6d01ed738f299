#include "harness/cli/examination.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/host/smoke.hpp"
#include "harness/port/profiles.hpp"
#include "harness/report/document.hpp"
#include "harness/report/text.hpp"
#include "harness/verify/verdict.hpp"

namespace attest::cli {
namespace {

// Bad findings that a port usually repeats in each unit and profile.
constexpr std::size_t bad_findings_shown = 4;

// "the machine, the suite and the reference work"
std::string at_work(std::vector<std::string> names) {
  const std::string last = names.back();
  names.pop_back();
  if (names.empty()) return last + " works";
  return fmt::format("{} and {} work", fmt::join(names, ", "), last);
}

void print_line(const std::string& line) {
  fmt::print("{}", broken_at(terminal_style(stdout).width, line + "\n"));
}

void examine_profile(const HostOptions& options, const std::string& profile,
                     Examination& examination) {
  std::vector<std::string> names;
  std::size_t checks = 0;
  const std::size_t bad_before = examination.bad_checks();
  smoke(options, profile, [&](const SmokeFinding& finding) {
    ++checks;
    if (std::ranges::find(names, finding.check) == names.end()) names.push_back(finding.check);
    if (!finding.is_good) return examination.bad(finding.check, finding.what, exit_failed);
    finding.is_remark ? examination.remark(finding.check, finding.what)
                      : examination.good_detail(finding.check, finding.what);
  });
  if (examination.bad_checks() > bad_before) return;
  examination.summary(profile,
                      fmt::format("{}: {}", counted(checks, "check"), fmt::join(names, ", ")));
}

}  // namespace

void Examination::print(const std::string& what, const std::string& finding) const {
  if (!quiet_) print_line(fmt::format("{:<6} {:<10} {}", name_of(Conclusion::pass), what, finding));
}

void Examination::good(const std::string& what, const std::string& finding) {
  ++parts_.back().checks;
  print(what, finding);
}

void Examination::good_detail(const std::string& what, const std::string& finding) {
  ++parts_.back().checks;
  if (verbose_) print(what, finding);
}

void Examination::summary(const std::string& what, const std::string& finding) const {
  if (!verbose_) print(what, finding);
}

void Examination::remark(const std::string& what, const std::string& finding) {
  ++parts_.back().checks;
  const bool is_new = remarks_.insert(what + finding).second;
  if (is_new || verbose_) print(what, finding);
}

void Examination::partly_good(const std::string& what, const std::string& finding,
                              const std::string& lack) {
  good(what, finding);
  lacks_.push_back(lack);
}

void Examination::bad(const std::string& what, const std::string& finding, Exit code) {
  Part& part = parts_.back();
  ++part.checks;
  ++part.bad;
  if (part.first_bad.empty()) part.first_bad = fmt::format("{}: {}", what, one_line(finding));
  code_ = std::max(code_, code);
  if (part.bad > bad_findings_shown && !verbose_) return;
  print_line(fmt::format("{:<6} {:<10} {}", capitals(name_of(Conclusion::fail)), what, finding));
}

std::size_t Examination::bad_checks() const { return parts_.back().bad; }

std::string Examination::sentence() const {
  std::vector<std::string> good, broken;
  std::size_t checks = 0;
  for (const Part& part : parts_) {
    checks += part.checks;
    if (part.bad == 0) {
      good.push_back(part.name);
      continue;
    }
    const std::string more =
        part.bad == 1 ? "" : fmt::format(", and {} more of {} checks", part.bad - 1, part.checks);
    broken.push_back(fmt::format("{} does not work: {}{}", part.name, part.first_bad, more));
  }
  std::string out = fmt::format("{}", fmt::join(broken, "; "));
  if (!good.empty()) out += (broken.empty() ? "" : "; ") + at_work(good);
  if (broken.empty()) out += ": " + counted(checks, "check");
  for (const std::string& lack : lacks_) out += "; " + lack;
  return out;
}

Exit Examination::conclude() const {
  if (quiet_ && code_ == exit_ok) return code_;
  const Conclusion conclusion = code_ == exit_ok ? Conclusion::pass : Conclusion::fail;
  const TerminalStyle style = terminal_style(stdout);
  const std::string word =
      painted(capitals(name_of(conclusion)), colour_of(verdict_of(conclusion)), style);
  print_line(fmt::format("{} {}", word, sentence()));
  return code_;
}

void examine_port(const HostOptions& options, Examination& examination) {
  const auto known = known_profile_names();
  const std::string& specification = options.port;
  examination.begin(fmt::format("the port `{}`", one_line(specification)));
  const auto port = describe_port(options, known);
  if (!port) return examination.bad("port", port.error().to_string());
  for (const std::string& trouble : {port->hangs, port->goes_wrong}) {
    if (trouble.empty()) continue;
    return examination.bad("port", specification + ": " + trouble, exit_failed);
  }
  const std::string who =
      fmt::format("{}: {} {}", specification, one_line(port->name), one_line(port->version));
  std::string printed;
  for (const auto& [profile, words] : port->refusals) {
    if (!words.empty()) printed += fmt::format("; for {} it printed: {}", profile, words);
  }
  if (port->profiles.empty()) {
    return examination.bad("port",
                           fmt::format("{}; create() returned NULL for each of {}{}. It must "
                                       "return a unit for at least one of them",
                                       who, fmt::join(known, ", "), printed));
  }
  examination.good("port", fmt::format("{}, profiles {}", who, fmt::join(port->profiles, ", ")));
  for (const std::string& profile : port->profiles) {
    examine_profile(options, profile, examination);
  }
}

void add_verbose(const Command& command, bool& verbose) {
  command.flag("-v,--verbose", verbose, "Print every check, not only a line for each profile");
}

}  // namespace attest::cli
