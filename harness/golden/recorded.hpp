// A trace that was recorded elsewhere, with the profile and the module of a port to replay it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/trace/trace_parts.hpp"

namespace attest {

// The profile for a log of the controller that does not show whether it is of v1.5.5 or v1.3.4.
inline constexpr const char* default_profile = "px4-v1.5.5";

struct Recorded {
  Trace trace;
  ModuleUnderTest subject;
  // Assumptions and omissions that let a port replay the trace: one line each.
  std::vector<std::string> notes;
};

// The same, read part by part.
class RecordedParts final : public TraceParts {
 public:
  // Errors: those of read_recorded() that the first tick shows; next_part() has the others.
  static Result<RecordedParts> open(const std::filesystem::path& file,
                                    const std::string& profile = "", const std::string& mixer = "");

  const std::string& file() const override { return reader_->file(); }
  const ChannelSet& present() const override { return reader_->present(); }
  const ModuleUnderTest& subject() const { return subject_; }
  const std::vector<std::string>& notes() const { return notes_; }

  // Same as override_parameter(), for the trace as a whole. REQUIRES: no part was read since the
  // trace was opened or rewound.
  void override_parameter(const ParameterChange& change);

  Result<void> next_part(std::size_t most, Trace& part) override;
  Result<void> rewind() override;

 private:
  RecordedParts(std::unique_ptr<TraceParts> reader, ModuleUnderTest subject)
      : reader_(std::move(reader)), subject_(std::move(subject)) {}
  void adapt_parameters(const Trace& first);
  void give_cells(const Trace& first);

  std::unique_ptr<TraceParts> reader_;
  ModuleUnderTest subject_;
  std::vector<std::string> notes_;
  std::set<std::string> foreign_;       // parameters of the file that are left out
  std::set<std::string> overridden_;    // parameters of the file that `added_` replaces
  std::vector<ParameterChange> added_;  // set before those of the file
  bool is_at_begin_ = true;
};

// Reads inputs and outputs. The file of a mixer may have the format of mixer_csv.hpp. An empty
// `profile` or `mixer` is taken from the provenance.toml in the folder of the file; a pipe has no
// provenance. Without an entry there, the profile is the newest released one that has the module
// (px4-v1.5.5 or px4-v1.16.0), and the mixer is the unscaled geometry that the file is named after
// ("4x.csv"). Parameters that only other profiles have are left out. A battery without BAT_N_CELLS
// has 3 cells, as in the recordings of the firmware. Errors: those of read_csv() and
// check_parameter(); a mixer trace whose definition is missing, invalid, or of another number of
// rotors; a `mixer` for a trace of another module.
Result<Recorded> read_recorded(const std::filesystem::path& file, const std::string& profile = "",
                               const std::string& mixer = "");

// Errors: in that profile the module does not have such a parameter, or does not accept the value.
Result<void> check_parameter(const ModuleUnderTest& subject, const ParameterChange& change);

// The change replaces all changes of that parameter in the trace.
void override_parameter(const ParameterChange& change, Trace& trace);

}  // namespace attest
