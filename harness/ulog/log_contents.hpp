// What a log has for each module that can be replayed, and its samples.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/trace/trace.hpp"
#include "harness/ulog/log_series.hpp"
#include "harness/ulog/step_gaps.hpp"
#include "harness/ulog/time_check.hpp"

namespace attest::ulog {

// A version of PX4: 1, 14, 3 is v1.14.3.
struct Release {
  int major = 0, minor = 0, patch = 0;
  // What kind of build it is: 0 to 63 dev, 64 to 127 alpha, 128 to 191 beta, 192 to 254 rc, 255 a
  // release.
  int type = 255;

  bool is_final() const { return type == 255; }
  std::string_view kind() const;  // "dev"; "release" if it is final
  std::string to_string() const;  // "v1.14.3", "v1.15.0-dev"
};

// How far the order of the samples in the file is from that of their times.
struct SampleOrder {
  // The place in the file of the last sample that is not later than the first step.
  std::uint64_t first_step_until = 0;
  // Any other sample is in the file before the first step that is later by more than this.
  std::uint64_t latest_us = 0;
};

class ModuleContents {
 public:
  explicit ModuleContents(Module module);

  Module module() const { return module_; }
  std::vector<LogSeries>& series() { return series_; }
  const std::vector<LogSeries>& series() const { return series_; }
  // The samples of the topic that triggers a step.
  const LogSeries& steps() const { return series_[steps_]; }
  LogSeries& steps() { return const_cast<LogSeries&>(std::as_const(*this).steps()); }
  // The input or output topic of that name; null if the module has none.
  const LogSeries* input(std::string_view topic) const { return find(topic, false); }
  const LogSeries* output(std::string_view topic) const { return find(topic, true); }
  // Whether an output topic has samples and at least one known field.
  bool has_outputs() const;

  // Whether a sample of the series is taken if its time fits like this. REQUIRES: `series` is one
  // of series().
  bool takes(const LogSeries& series, TimeFit fit) const {
    return fit == TimeFit::plausible || (fit == TimeFit::too_early && &series != &steps());
  }
  // Counts the last sample that `reader` read. REQUIRES: `series` is one of series(), and accepts
  // it.
  void count(LogSeries& series, const Reader& reader, const Data& data, TimeFit fit);
  // `fastest_hz`: as for GapCounts::gaps().
  StepGaps step_gaps(std::optional<double> fastest_hz) const {
    return gap_counts_.gaps(fastest_hz);
  }
  const SampleOrder& order() const { return order_; }

  std::vector<ParameterChange> parameters;  // `tick`: the number of steps logged before the change

 private:
  const LogSeries* find(std::string_view topic, bool is_output) const;

  Module module_;
  std::size_t steps_ = 0;  // index of the topic that triggers a step
  std::vector<LogSeries> series_;
  GapCounts gap_counts_;
  std::uint64_t first_step_us_ = 0;
  SampleOrder order_;
};

struct LogContents {
  std::vector<ModuleContents> modules;   // controller, attitude unit, rate unit
  std::string system, firmware, source;  // sys_name, ver_sw, attest_source
  std::string branch;                    // ver_sw_branch, the Git branch of the firmware
  std::optional<Release> release;        // ver_sw_release
  bool has_data = false;                 // of any topic
  std::size_t dropouts = 0;              // times that the logger lost messages
  std::vector<std::string> damage;       // one line each
  bool may_lack_samples = false;         // because of the damage

  bool is_of_attest() const { return system == "attest"; }  // written by write_trace()
  ModuleContents& of(Module module);
};

// Reads the whole log. Counts the samples of the modules' topics, and keeps no sample. Errors: the
// file cannot be read or is not a ULog.
Result<LogContents> read_contents(const std::filesystem::path& path);

// Reads the samples of one module of a log again. Keeps them until their series forget them.
class SampleReader {
 public:
  // REQUIRES: read_contents() made `log`, which outlives this.
  static Result<SampleReader> open(const std::string& path, ModuleContents& log);

  // Reads until the series have all samples up to this time.
  Result<void> read_until(std::uint64_t time_us);
  // Reads some samples. False: the log has ended.
  Result<bool> read_more();
  bool has_ended() const { return has_ended_; }

 private:
  SampleReader(Reader reader, ModuleContents& log) : reader_(std::move(reader)), log_(&log) {}

  Result<void> read_message();
  bool has_all(std::uint64_t time_us) const;

  Reader reader_;
  TimeCheck times_;
  ModuleContents* log_;
  bool has_ended_ = false;
  std::vector<std::optional<std::vector<LogSeries*>>> receivers_;  // by subscription
};

}  // namespace attest::ulog
