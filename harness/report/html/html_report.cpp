#include "harness/report/html/html_report.hpp"

#include <algorithm>
#include <string_view>

#include "harness/report/html/page_data.hpp"
#include "harness/report/html/plots.hpp"

namespace attest {

std::string html_report(const Report& report) {
  // The last occurrence of these characters is that of the template, because mustache escapes the
  // quotes and `>` in the texts of a port.
  constexpr std::string_view begin_of_plots = R"(id="plots">)";
  std::string page = filled_page(report);
  const std::size_t left = most_page_bytes - std::min(most_page_bytes, page.size());
  page.insert(page.rfind(begin_of_plots) + begin_of_plots.size(),
              plots_json(report.run, report.traces, left));
  return page;
}

}  // namespace attest
