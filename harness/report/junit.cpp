#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "harness/report/conclusion.hpp"
#include "harness/report/failure_text.hpp"
#include "harness/report/matrix.hpp"
#include "harness/report/report.hpp"
#include "harness/report/statement.hpp"
#include "harness/report/text.hpp"

namespace attest {
namespace {

void set_attribute(pugi::xml_node node, const char* name, const std::string& value) {
  node.append_attribute(name).set_value(value.c_str());
}

// The element in a testcase; empty for a pass.
std::string_view element_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "";
    case Verdict::fail:
    case Verdict::non_finite:
    case Verdict::xpass:
      return "failure";
    case Verdict::unsupported:
    case Verdict::skip:
    case Verdict::xfail:
      return "skipped";
    case Verdict::crash:
    case Verdict::timeout:
    case Verdict::protocol:
      break;
  }
  return "error";
}

struct Counts {
  std::size_t tests = 0;
  std::size_t failures = 0;
  std::size_t errors = 0;
  std::size_t skipped = 0;
  double time_s = 0;

  void add(const VectorResult& result) {
    const std::string_view element = element_of(result.verdict);
    tests += 1;
    failures += element == "failure" ? 1 : 0;
    errors += element == "error" ? 1 : 0;
    skipped += element == "skipped" ? 1 : 0;
    if (std::isfinite(result.elapsed_s)) time_s += std::max(result.elapsed_s, 0.0);
  }

  void add_skipped() {
    ++tests;
    ++skipped;
  }

  void add_errors(std::size_t count) {
    tests += count;
    errors += count;
  }
};

// Readers take digits and a point only, no exponent.
std::string seconds(double time_s) {
  return fmt::format("{:.6f}", std::isfinite(time_s) && time_s > 0 ? time_s : 0.0);
}

void set_counts(pugi::xml_node node, const Counts& counts) {
  set_attribute(node, "tests", fmt::to_string(counts.tests));
  set_attribute(node, "failures", fmt::to_string(counts.failures));
  set_attribute(node, "errors", fmt::to_string(counts.errors));
}

void add_properties(pugi::xml_node suite, const RunResult& run) {
  pugi::xml_node properties = suite.append_child("properties");
  const std::pair<const char*, std::string> all[] = {
      {"attest.version", run.attest_version},
      {"port", run.port},
      {"port.name", run.port_name},
      {"port.version", run.port_version},
      {"port.fraction_bits", run.fraction_bits ? fmt::to_string(*run.fraction_bits) : "none"},
      {"port.fixed_step", run.fixed_step ? run.fixed_step->to_string() : "none"},
      {"level", std::string(name_of(run.level))},
      {"cases.version", run.cases_version},
      {"golden.version", run.golden_version},
      {"suite.sha256", run.suite_sha256.empty() ? "none" : run.suite_sha256},
      {"suite.released", run.suite_is_released ? "true" : "false"},
      {"port.sha256", run.port_sha256.empty() ? "none" : run.port_sha256},
      {"date", run.date.empty() ? "none" : run.date},
      {"conformance", run.command == "run" ? conformance_statement(run) : "not judged"},
      {"stopped_early", run.stopped_early ? "true" : "false"},
  };
  for (const auto& [name, value] : all) {
    pugi::xml_node property = properties.append_child("property");
    set_attribute(property, "name", name);
    set_attribute(property, "value", one_line(value));
  }
}

// `type` must not be one of the words that ActiveSupport (GitLab) casts by: "file", "float", ...
void add_outcome(pugi::xml_node test, std::string_view element, std::string_view type,
                 const std::string& message, const std::string& content) {
  pugi::xml_node node = test.append_child(std::string(element).c_str());
  set_attribute(node, "type", std::string(type));
  set_attribute(node, "message", message);
  node.text().set(content.c_str());
}

pugi::xml_node add_test(pugi::xml_node suite, const std::string& classname, const std::string& name,
                        double elapsed_s) {
  pugi::xml_node test = suite.append_child("testcase");
  set_attribute(test, "classname", classname);
  set_attribute(test, "name", name);
  set_attribute(test, "time", seconds(elapsed_s));
  return test;
}

// `of`: a VectorResult or NotRun.
std::string suite_name(const auto& of) { return one_line(of.profile + "." + of.group); }

// Each failure contains the diagnosis, because on the page of one test CI servers do not show the
// rest of the run.
std::string failure_content(const VectorResult& result, const RunResult& run,
                            const std::optional<Diagnosis>& diagnosis) {
  const std::string text = failure_text(result, run);
  if (!diagnosis || !result.first) return text;
  return text + "\nFrom all failures in this run, " + diagnosis_text(*diagnosis);
}

void add_result(pugi::xml_node suite, const VectorResult& result, const RunResult& run,
                const std::optional<Diagnosis>& diagnosis) {
  const std::string name = one_line(result.name + "@" + result.configuration().label());
  const pugi::xml_node test = add_test(suite, suite_name(result), name, result.elapsed_s);
  const std::string_view element = element_of(result.verdict);
  if (element.empty()) return;
  const std::string headline = failure_headline(result);
  add_outcome(test, element, name_of(result.verdict), headline,
              element == "skipped" ? headline : failure_content(result, run, diagnosis));
}

pugi::xml_node add_suite(pugi::xml_node root, const std::string& name, const Counts& counts,
                         const RunResult& run) {
  pugi::xml_node suite = root.append_child("testsuite");
  set_attribute(suite, "name", name);
  set_counts(suite, counts);
  set_attribute(suite, "skipped", fmt::to_string(counts.skipped));
  set_attribute(suite, "time", seconds(counts.time_s));
  add_properties(suite, run);
  return suite;
}

// Suite -> its vectors that were not run.
std::map<std::string, std::size_t> not_run_by_suite(const RunResult& run) {
  std::map<std::string, std::size_t> left;
  for (const NotRun& one : run.not_run) left[suite_name(one)] += one.vectors;
  return left;
}

// Else a suite of which only a part was run looks like one that passed.
void add_not_run(pugi::xml_node suite, const std::string& name, std::size_t left) {
  const pugi::xml_node test = add_test(suite, name, "not_run", 0);
  const std::string message = counted(left, "vector") + " not run: the run was stopped";
  add_outcome(test, "skipped", name_of(Conclusion::stopped), message, message);
}

void add_environment(pugi::xml_node root, const RunResult& run) {
  if (run.errors.empty()) return;
  const std::string name = "attest.environment";
  Counts counts;
  counts.add_errors(run.errors.size());
  const pugi::xml_node suite = add_suite(root, name, counts, run);
  for (std::size_t i = 0; i < run.errors.size(); ++i) {
    const std::string text = run.errors[i].to_string();
    const pugi::xml_node test = add_test(suite, name, fmt::format("error_{}", i + 1), 0);
    add_outcome(test, "error", "environment", one_line(text), printable(text));
  }
}

}  // namespace

std::string junit_report(const RunResult& run, const std::optional<Diagnosis>& diagnosis) {
  Counts all;
  for (const VectorResult& result : run.results) all.add(result);
  all.add_errors(run.errors.size());

  pugi::xml_document document;
  pugi::xml_node declaration = document.append_child(pugi::node_declaration);
  set_attribute(declaration, "version", "1.0");
  set_attribute(declaration, "encoding", "UTF-8");
  pugi::xml_node root = document.append_child("testsuites");
  set_attribute(root, "name", "attest");
  const auto suites = grouped(
      run, [](const VectorResult&) { return true; },
      [](const VectorResult& a, const VectorResult& b) {
        return a.profile == b.profile && a.group == b.group;
      });
  auto not_run = not_run_by_suite(run);
  for (std::size_t i = 0; i < not_run.size(); ++i) all.add_skipped();
  for (const Together& suite : suites) {
    const std::string name = suite_name(*suite.front());
    const auto left = not_run.extract(name);
    Counts counts;
    for (const VectorResult* result : suite) counts.add(*result);
    if (left) counts.add_skipped();
    const pugi::xml_node node = add_suite(root, name, counts, run);
    for (const VectorResult* result : suite) add_result(node, *result, run, diagnosis);
    if (left) add_not_run(node, name, left.mapped());
  }
  for (const auto& [name, left] : not_run) {  // of these suites no vector was run
    Counts counts;
    counts.add_skipped();
    add_not_run(add_suite(root, name, counts, run), name, left);
  }
  add_environment(root, run);
  // No `skipped` here: the schema of Jenkins' xUnit plugin does not allow it and rejects the file.
  set_counts(root, all);
  set_attribute(root, "time", seconds(all.time_s));
  std::ostringstream out;
  document.save(out, "  ", pugi::format_default, pugi::encoding_utf8);
  return out.str();
}

}  // namespace attest
