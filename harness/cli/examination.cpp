#include "harness/cli/examination.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/host/smoke.hpp"
#include "harness/port/profiles.hpp"
#include "harness/report/text.hpp"
#include "harness/verify/verdict.hpp"

namespace attest::cli {

void Examination::good(const std::string& what, const std::string& finding) const {
  fmt::print("{:<6} {:<10} {}\n", name_of(Conclusion::pass), what, finding);
}

void Examination::bad(const std::string& what, const std::string& finding, Exit code) {
  fmt::print("{:<6} {:<10} {}\n", capitals(name_of(Conclusion::fail)), what, finding);
  code_ = std::max(code_, code);
}

void Examination::check(bool is_good, const std::string& what, const std::string& finding,
                        Exit code) {
  is_good ? good(what, finding) : bad(what, finding, code);
}

void examine_port(const HostOptions& options, Examination& examination) {
  const auto known = known_profile_names();
  const std::string& specification = options.port;
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
    return examination.bad("port", fmt::format("{}; create() returned NULL for each of {}{}", who,
                                               fmt::join(known, ", "), printed));
  }
  examination.good("port", fmt::format("{}, profiles {}", who, fmt::join(port->profiles, ", ")));
  for (const std::string& profile : port->profiles) {
    smoke(options, profile, [&](const SmokeFinding& finding) {
      examination.check(finding.is_good, finding.check, finding.what, exit_failed);
    });
  }
}

}  // namespace attest::cli
