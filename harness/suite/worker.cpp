#include "harness/suite/worker.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/core/float_environment.hpp"
#include "harness/process/child.hpp"
#include "harness/suite/error_json.hpp"
#include "harness/suite/pool.hpp"

namespace attest {
namespace {

using nlohmann::json;

bool any_failed(const WorkerOutcome& outcome, const WorkerOptions& options) {
  return !outcome.errors.empty() ||
         std::any_of(outcome.results.begin(), outcome.results.end(), options.fails);
}

void run_batch_here(Batch& batch, HeldPort& port, const WorkerOptions& options,
                    WorkerOutcome& outcome) {
  if (const auto opened = batch.open(); !opened) {
    outcome.errors.push_back(opened.error());
    return;
  }
  for (std::size_t i = 0; i < batch.size(); ++i) {
    auto result = batch.evaluate(i, port);
    if (result) {
      port.hold(*result);
      options.on_result(*result);
      outcome.results.push_back(std::move(*result));
    } else {
      outcome.errors.push_back(result.error());
    }
  }
}

WorkerOutcome run_here(const Batches& batches, const WorkerOptions& options) {
  // A port that changes the environment when it is loaded changes that of the caller here.
  const DefaultFloatEnvironment callers;
  WorkerOutcome outcome;
  auto opened = open_port(options.port);
  if (!opened) return {{}, {opened.error()}, false};
  HeldPort port(std::move(*opened), options.said);
  for (std::size_t index = 0; index < batches.size() && !options.stop(); ++index) {
    run_batch_here(*batches[index], port, options, outcome);
    if (options.fail_fast && any_failed(outcome, options)) {
      outcome.stopped_early = index + 1 < batches.size();
      break;
    }
  }
  return outcome;
}

// Words of a port and paths may not be UTF-8.
std::string repaired(const json& message) {
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

void send_description(const std::string& specification, const std::vector<std::string>& profiles,
                      const SendLine& send) {
  auto port = open_port(specification);
  if (!port) return send(repaired({{"error", to_json(port.error())}}));
  const PortSays says = PortSays::asked(**port);
  json supported = json::array();
  for (const std::string& profile : profiles) {
    if ((*port)->create(profile)) supported.push_back(profile);
  }
  json description = {
      {"name", says.name},           {"version", says.version},
      {"profiles", supported},       {"unsupported_groups", says.unsupported_groups},
      {"has_mixer", says.has_mixer}, {"has_battery_status", says.has_battery_status}};
  if (says.fraction_bits) description["fraction_bits"] = *says.fraction_bits;
  if (says.fixed_step) description["fixed_step"] = says.fixed_step->to_string();
  send(repaired(description));
}

}  // namespace

WorkerOutcome run_batches(const Batches& batches, const WorkerOptions& options) {
  return options.in_process ? run_here(batches, options) : Pool(batches, options).run();
}

Result<PortDescription> describe_port(const std::string& port,
                                      const std::vector<std::string>& profiles, double timeout_s,
                                      const std::function<bool()>& stop) {
  auto child = Child::spawn([&](const SendLine& send) { send_description(port, profiles, send); });
  if (!child) return tl::unexpected(child.error());
  const auto line = child->wait_for_line(timeout_s, stop);
  if (!line) {
    constexpr const char* asked = "when it was loaded and asked for its name and profiles";
    if (child->was_killed()) {
      PortDescription silent;
      silent.hangs = fmt::format("gave no answer within {} s, {}", timeout_s, asked);
      return silent;
    }
    return fail_at(port, fmt::format("gave no answer {}: its process {}", asked, child->end()));
  }
  const json answer = json::parse(*line, nullptr, false);
  if (answer.is_object() && answer.contains("error")) {
    auto error = error_from_json(answer["error"]);
    return tl::unexpected(error ? *error : error.error());
  }
  if (!answer.is_object()) return fail_at(port, "gave no sensible description of itself");
  PortDescription description;
  description.name = answer.value("name", "");
  description.version = answer.value("version", "");
  description.profiles = answer.value("profiles", std::vector<std::string>{});
  description.unsupported_groups = answer.value("unsupported_groups", std::vector<std::string>{});
  description.has_mixer = answer.value("has_mixer", false);
  description.has_battery_status = answer.value("has_battery_status", false);
  if (answer.contains("fraction_bits")) {
    description.fraction_bits = answer.value("fraction_bits", 0);
  }
  if (const auto step = Rate::parse(answer.value("fixed_step", ""))) {
    description.fixed_step = *step;
  }
  return description;
}

std::vector<std::string> supported_profiles(const std::string& port,
                                            const std::vector<std::string>& profiles,
                                            double timeout_s, const std::function<bool()>& stop) {
  std::vector<std::string> supported;
  for (const std::string& profile : profiles) {
    const auto description = describe_port(port, {profile}, timeout_s, stop);
    if (!description || !description->hangs.empty()) break;
    if (!description->profiles.empty()) supported.push_back(profile);
  }
  return supported;
}

}  // namespace attest
