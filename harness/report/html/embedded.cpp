#include "harness/report/html/embedded.hpp"

#include "harness/core/embed.hpp"

ATTEST_EMBED(page_template, ATTEST_PAGE_TEMPLATE);
ATTEST_EMBED(page_style, ATTEST_PAGE_STYLE);
ATTEST_EMBED(results_style, ATTEST_RESULTS_STYLE);
ATTEST_EMBED(page_script, ATTEST_PAGE_SCRIPT);
ATTEST_EMBED(details_script, ATTEST_DETAILS_SCRIPT);
ATTEST_EMBED(plots_script, ATTEST_PLOTS_SCRIPT);
ATTEST_EMBED(shared_script, ATTEST_SHARED_SCRIPT);
ATTEST_EMBED(plot_page_script, ATTEST_PLOT_PAGE_SCRIPT);
ATTEST_EMBED(replay_script, ATTEST_REPLAY_SCRIPT);
ATTEST_EMBED(dygraphs_script, ATTEST_DYGRAPHS_SCRIPT);
ATTEST_EMBED(dygraphs_style, ATTEST_DYGRAPHS_STYLE);
ATTEST_EMBED(dygraphs_synchronizer, ATTEST_DYGRAPHS_SYNCHRONIZER);
ATTEST_EMBED(dygraphs_licence, ATTEST_DYGRAPHS_LICENCE);

namespace attest {
namespace {

// Without the comment that names a source map: a browser's debugger would request that file.
std::string_view without_source_map(std::string_view text) {
  return text.substr(0, text.find("# sourceMappingURL=") - 2);
}

}  // namespace

std::string_view page_template() { return ATTEST_EMBEDDED(page_template); }
std::string_view page_style() { return ATTEST_EMBEDDED(page_style); }
std::string_view results_style() { return ATTEST_EMBEDDED(results_style); }
std::string_view page_script() { return ATTEST_EMBEDDED(page_script); }
std::string_view details_script() { return ATTEST_EMBEDDED(details_script); }
std::string_view plots_script() { return ATTEST_EMBEDDED(plots_script); }
std::string_view shared_script() { return ATTEST_EMBEDDED(shared_script); }
std::string_view plot_page_script() { return ATTEST_EMBEDDED(plot_page_script); }
std::string_view replay_script() { return ATTEST_EMBEDDED(replay_script); }
std::string_view dygraphs_script() { return without_source_map(ATTEST_EMBEDDED(dygraphs_script)); }
std::string_view dygraphs_style() { return without_source_map(ATTEST_EMBEDDED(dygraphs_style)); }
std::string_view dygraphs_synchronizer() { return ATTEST_EMBEDDED(dygraphs_synchronizer); }
std::string_view dygraphs_licence() { return ATTEST_EMBEDDED(dygraphs_licence); }

}  // namespace attest
