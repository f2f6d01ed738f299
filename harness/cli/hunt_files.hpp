// The files of a hunt: those that it begins with, and those that it writes.
#pragma once

#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/diagnosis/hunt_corpus.hpp"
#include "harness/report/hunt_document.hpp"

namespace attest::cli {

struct HuntFiles {
  std::string corpus, out;  // folders of suites; may be empty
  std::vector<std::string> logs;
  std::vector<std::string> assumed;  // in the logs: assumption_words()
};

// Errors: the path is that of a file.
Result<void> check_may_be_folder(const std::string& folder);

// The corpus in the suite `root`, which is made if it does not exist. Errors: those of
// HuntCorpus::open(); the folder has files, and is no suite.
Result<HuntCorpus> open_corpus(const std::string& root, const HuntOptions& hunt);

// Inputs of the logs, as far as they are of the subjects of the hunt. `profile`: that of the logs;
// empty: as they say. Adds a line for each log to `notes`. Errors: those of read_log(); a log
// without such inputs.
Result<std::vector<HuntInputs>> inputs_of_logs(const HuntFiles& files, const std::string& profile,
                                               const HuntOptions& hunt,
                                               std::vector<std::string>& notes);

// Adds the findings to the corpus.
Result<void> add_findings(const HuntRun& found, HuntCorpus& corpus);

// "corpus found: began with 12 cases, skipped 3 (a flight); added 5".
std::string corpus_note(const std::string& root, const HuntCorpus& corpus);

// Writes each finding as a case of the suite `out`, and its inputs with the right outputs as a
// trace. `out` may be empty.
Result<void> write_findings(const std::string& out, HuntReport& report);

}  // namespace attest::cli
