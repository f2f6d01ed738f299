// A port may change the floating point environment of its process: a library linked with
// -ffast-math sets flush-to-zero when it is loaded. The harness computes and compares in the
// default environment, and restores the port's environment for the calls of the port.
#pragma once

#include <cfenv>

namespace attest {

class DefaultFloatEnvironment {
 public:
  DefaultFloatEnvironment() {
    std::fegetenv(&saved_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~DefaultFloatEnvironment() { std::fesetenv(&saved_); }
  DefaultFloatEnvironment(const DefaultFloatEnvironment&) = delete;
  DefaultFloatEnvironment& operator=(const DefaultFloatEnvironment&) = delete;

 private:
  std::fenv_t saved_;
};

// Keeps the environment of a port between its calls, while the harness computes in another one. It
// begins with the environment in which this object is made.
class PortFloatEnvironment {
 public:
  PortFloatEnvironment() { std::fegetenv(&ports_); }

  template <typename Call>
  auto run(Call&& call) {
    std::fenv_t ours;
    std::fegetenv(&ours);
    std::fesetenv(&ports_);
    auto result = call();
    std::fegetenv(&ports_);
    std::fesetenv(&ours);
    return result;
  }

 private:
  std::fenv_t ports_;
};

}  // namespace attest
