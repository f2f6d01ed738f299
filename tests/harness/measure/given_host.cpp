#include "tests/harness/measure/given_host.hpp"

namespace attest {
namespace {

const StartedHosts::Start* given_start = nullptr;

}  // namespace

using Started = Result<std::unique_ptr<PortHost>>;

// Where start_host() is called the linker calls the first; the second is start_host() itself.
Started start_given(const HostOptions&, const Course&) asm("__wrap_" ATTEST_START_HOST);
Started start_real(const HostOptions&, const Course&) asm("__real_" ATTEST_START_HOST);

Started start_given(const HostOptions& options, const Course& course) {
  return given_start ? (*given_start)(options, course) : start_real(options, course);
}

StartedHosts::StartedHosts(Start start) : start_(std::move(start)) { given_start = &start_; }

StartedHosts::~StartedHosts() { given_start = nullptr; }

}  // namespace attest
