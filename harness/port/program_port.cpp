#include "harness/port/program_port.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

#include <fmt/format.h>
#include <wordexp.h>

#include "harness/port/conversation.hpp"
#include "harness/port/module_place.hpp"
#include "harness/port/published.hpp"
#include "harness/process/program.hpp"

namespace attest {
namespace {

// Changes the outputs of the step before into those that were answered.
void take(const attest_outputs& answered, attest_outputs& out) {
  attest_outputs now = answered;
  keep_unpublished(out, now);
  out = now;
}

// Mixer and battery estimate have no topic that they may leave out.
template <typename Outputs>
void take(const Outputs& answered, Outputs& out) {
  out = answered;
}

// Shared by the port and its units, because a unit may outlive the conversation of its port.
using Talk = std::shared_ptr<Conversation>;

template <typename Base>
class ProgramUnit : public Base {
 public:
  using typename Base::Inputs;
  using typename Base::Outputs;
  using Its = ModulePlace<Base>;

  ProgramUnit(Talk talk, std::uint32_t number) : talk_(std::move(talk)), number_(number) {}
  ~ProgramUnit() override { talk_->destroy_quietly(number_); }
  ProgramUnit(const ProgramUnit&) = delete;
  ProgramUnit& operator=(const ProgramUnit&) = delete;

  int set_parameter(const std::string& name, float value) override {
    return talk_->set_parameter(number_, name, value);
  }

  int step(const Inputs& in, Outputs& out) override {
    set(step_, in, timestamp_sample_us_);
    step_.sample.*Its::out = out;
    const int result = talk_->step(number_, Its::module, step_);
    if (result == ATTEST_OK) take(step_.sample.*Its::out, out);
    return result;
  }

  std::size_t max_batch() const override {
    return talk_->hello().has_batch ? attest::max_batch : 0;
  }

  Batched batch(std::span<const Inputs> in, std::span<Outputs> out,
                std::span<const std::uint64_t> timestamps_us) override {
    batch_.resize(in.size());
    for (std::size_t i = 0; i < in.size(); ++i) set(batch_[i], in[i], timestamps_us[i]);
    Batched batched;
    batched.result = talk_->batch(number_, Its::module, batch_, batched.done);
    for (std::size_t i = 0; i < batched.done; ++i) {
      if (i > 0) out[i] = out[i - 1];
      take(batch_[i].sample.*Its::out, out[i]);
    }
    return batched;
  }

 protected:
  void set_time(std::uint64_t timestamp_sample_us) { timestamp_sample_us_ = timestamp_sample_us; }

 private:
  static void set(ProgramStep& step, const Inputs& in, std::uint64_t timestamp_sample_us) {
    step.timestamp_sample_us = timestamp_sample_us;
    step.sample.*Its::in = in;
  }

  Talk talk_;
  std::uint32_t number_;
  std::uint64_t timestamp_sample_us_ = 0;
  ProgramStep step_;
  std::vector<ProgramStep> batch_;
};

class ProgramController final : public ProgramUnit<Unit> {
 public:
  using ProgramUnit::ProgramUnit;
  int set_timestamp_sample(std::uint64_t timestamp_sample_us) override {
    set_time(timestamp_sample_us);
    return ATTEST_OK;
  }
};

class ProgramPort final : public Port {
 public:
  ProgramPort(std::vector<std::string> command, Talk talk)
      : command_(std::move(command)), hello_(talk->hello()), talk_(std::move(talk)) {}

  std::string name() const override { return hello_.name; }
  std::string version() const override { return hello_.version; }
  std::vector<std::string> unsupported_groups() const override { return hello_.unsupported_groups; }
  std::optional<int> fraction_bits() const override { return hello_.fraction_bits; }
  std::optional<Rate> fixed_step() const override { return hello_.fixed_step; }
  bool has_mixer() const override { return hello_.has_mixer; }
  bool has_battery_status() const override { return hello_.has_battery_status; }

  void finish() override { talk_->throw_late(); }

  std::unique_ptr<Unit> create(const std::string& profile) override {
    return made<ProgramController>(Module::mc_att_control, profile, "");
  }
  std::unique_ptr<MixerUnit> create_mixer(const std::string& profile,
                                          const std::string& definition) override {
    return made<ProgramUnit<MixerUnit>>(Module::mixer, profile, definition);
  }
  std::unique_ptr<BatteryUnit> create_battery_status(const std::string& profile) override {
    return made<ProgramUnit<BatteryUnit>>(Module::battery_status, profile, "");
  }

 private:
  template <typename Made>
  std::unique_ptr<Made> made(Module module, const std::string& profile,
                             const std::string& definition) {
    const auto& profiles = hello_.profiles;
    if (std::find(profiles.begin(), profiles.end(), profile) == profiles.end()) return nullptr;
    if (talk_->is_over()) start_again();
    const std::uint32_t number = ++units_;
    const int result = talk_->create(number, module, profile, definition);
    if (result == ATTEST_OK) return std::make_unique<Made>(talk_, number);
    if (result == ATTEST_UNSUPPORTED) return nullptr;
    throw PortBroke(
        PortBroke::How::rules,
        fmt::format("the answer to the request `create` has the result {}; it is {} (ok) "
                    "or {} (unsupported)",
                    result, static_cast<int>(ATTEST_OK), static_cast<int>(ATTEST_UNSUPPORTED)));
  }

  void start_again() {
    auto talk = Conversation::begin(command_);
    if (!talk) throw PortBroke(PortBroke::How::ended, "started again, " + talk.error().message);
    talk_ = *std::move(talk);
    hello_ = talk_->hello();
  }

  std::vector<std::string> command_;
  Hello hello_;
  Talk talk_;
  std::uint32_t units_ = 0;
};

std::string why_not_split(int error) {
  switch (error) {
    case WRDE_BADCHAR:
      return "has one of the characters | & ; < > ( ) { } or a line end outside quotes; no shell "
             "runs, so put it in quotes, or put the command in a script";
    case WRDE_BADVAL:
      return "uses a variable that is not set";
    case WRDE_CMDSUB:
      return "uses command substitution; no shell runs, so put the command in a script";
    case WRDE_SYNTAX:
      return "has a quote or a brace that is not closed";
    default:
      return "is too long";
  }
}

}  // namespace

Result<std::vector<std::string>> words_of(const std::string& command) {
  wordexp_t split{};
  const int error = ::wordexp(command.c_str(), &split, WRDE_NOCMD | WRDE_UNDEF);
  std::vector<std::string> words;
  if (error == 0) words.assign(split.we_wordv, split.we_wordv + split.we_wordc);
  if (error == 0 || error == WRDE_NOSPACE) ::wordfree(&split);
  if (error != 0) return fail(fmt::format("the command `{}` {}", command, why_not_split(error)));
  if (words.empty()) return fail("`proc:` needs a command: --port \"proc:python3 port.py\"");
  return words;
}

Result<std::unique_ptr<Port>> open_program(const std::string& command) {
  auto words = words_of(command);
  if (!words) return tl::unexpected(words.error());
  if (!find_program(words->front())) {
    return fail_at(words->front(), words->front().find('/') == std::string::npos
                                       ? "no program of this name is in PATH"
                                       : "is no file that may be executed (chmod +x)");
  }
  auto talk = Conversation::begin(*words);
  if (!talk) return fail_at("proc:" + command, talk.error().message);
  return std::make_unique<ProgramPort>(*std::move(words), Talk(*std::move(talk)));
}

}  // namespace attest
