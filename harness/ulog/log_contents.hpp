// The samples of a log, for each module that can be replayed and each of its topics.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/trace/trace.hpp"
#include "harness/ulog/log_series.hpp"

namespace attest::ulog {

// A release of PX4: 1, 14, 3 is v1.14.3.
struct Release {
  int major = 0, minor = 0, patch = 0;

  std::string to_string() const;  // "v1.14.3"
};

class ModuleContents {
 public:
  explicit ModuleContents(Module module);

  Module module() const { return module_; }
  std::vector<LogSeries>& series() { return series_; }
  const std::vector<LogSeries>& series() const { return series_; }
  // The samples of the topic that triggers a step.
  const LogSeries& steps() const { return *input(step_topic_); }
  // The input or output topic of that name; null if the module has none.
  const LogSeries* input(std::string_view topic) const { return find(topic, false); }
  const LogSeries* output(std::string_view topic) const { return find(topic, true); }
  // Whether an output topic has samples and at least one known field.
  bool has_outputs() const;

  std::vector<ParameterChange> parameters;  // `tick`: the number of steps logged before the change

 private:
  const LogSeries* find(std::string_view topic, bool is_output) const;

  Module module_;
  std::string step_topic_;
  std::vector<LogSeries> series_;
};

struct LogContents {
  std::vector<ModuleContents> modules;   // controller, attitude unit, rate unit
  std::string system, firmware, source;  // sys_name, ver_sw, attest_source
  std::optional<Release> release;        // ver_sw_release
  std::size_t dropouts = 0;              // times that the logger lost messages
  std::vector<std::string> damage;       // one line each

  bool is_of_attest() const { return system == "attest"; }  // written by write_trace()
  ModuleContents& of(Module module);
};

// Reads the whole log. Keeps the samples of the modules' topics in memory. Errors: the file cannot
// be read or is not a ULog.
Result<LogContents> read_contents(const std::filesystem::path& path);

}  // namespace attest::ulog
