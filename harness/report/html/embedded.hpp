// The files of the pages, which are part of the attest binary.
#pragma once

#include <string_view>

namespace attest {

// The template (mustache) and the styles of all pages, and the scripts of the page of `run --html`.
std::string_view page_template();
std::string_view page_style();
std::string_view results_style();
std::string_view page_script();  // the list of results and the matrix
std::string_view details_script();
std::string_view plots_script();
std::string_view shared_script();

// The scripts of all other pages.
std::string_view plot_page_script();
std::string_view replay_script();

// Of the package libjs-dygraphs.
std::string_view dygraphs_script();
std::string_view dygraphs_style();
std::string_view dygraphs_synchronizer();
std::string_view dygraphs_licence();

}  // namespace attest
