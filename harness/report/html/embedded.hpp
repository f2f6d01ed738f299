// The files of the pages, which are part of the attest binary.
#pragma once

#include <string_view>

namespace attest {

// The page of `run --html`: its template (mustache), its styles and its scripts.
std::string_view page_template();
std::string_view page_style();
std::string_view results_style();
std::string_view page_script();  // the list of results and the matrix
std::string_view details_script();
std::string_view plots_script();
std::string_view shared_script();

// The page of a PlotPage, and its scripts.
std::string_view plot_page_template();
std::string_view plot_page_script();
std::string_view replay_script();

// Of the package libjs-dygraphs.
std::string_view dygraphs_script();
std::string_view dygraphs_style();
std::string_view dygraphs_synchronizer();
std::string_view dygraphs_licence();

}  // namespace attest
