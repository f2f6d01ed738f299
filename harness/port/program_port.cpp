#include "harness/port/program_port.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <wordexp.h>

#include "harness/port/conversation.hpp"
#include "harness/process/program.hpp"
#include "harness/trace/output_topics.hpp"

namespace attest {
namespace {

// Shared by the port and its units, because a unit may outlive the conversation of its port.
using Talk = std::shared_ptr<Conversation>;

class ProgramUnit final : public Unit {
 public:
  ProgramUnit(Talk talk, std::uint32_t number, Module module, const Lacks& lacks)
      : talk_(std::move(talk)), number_(number), info_(info_of(module)), lacks_(lacks) {}
  ~ProgramUnit() override { talk_->destroy_quietly(number_); }
  ProgramUnit(const ProgramUnit&) = delete;
  ProgramUnit& operator=(const ProgramUnit&) = delete;

  int set_parameter(const std::string& name, float value) override {
    const auto ask = [&] {
      const std::lock_guard lock(talk_->mutex());
      return talk_->set_parameter(number_, name, value);
    };
    const auto* const constant = lacks_.constant(name);
    return constant ? constant->answer_to(value, ask) : ask();
  }

  int set_timestamp_sample(std::uint64_t timestamp_sample_us) override {
    step_.timestamp_sample_us = timestamp_sample_us;
    return ATTEST_OK;
  }

  int step_structs(const void* in, void* out) override {
    Sample& sample = step_.sample;
    std::memcpy(info_.in.in(sample), in, info_.in.size);
    std::memcpy(info_.out.in(sample), out, info_.out.size);
    const Sample before = sample;
    costs_.clear();
    const int result = answer_to_step();
    if (result != ATTEST_OK) return result;
    if (talk_->hello().cost) costs_.push_back(step_.cost);
    keep_unpublished(info_.module, before, sample);
    std::memcpy(out, info_.out.in(sample), info_.out.size);
    return result;
  }

  std::size_t max_batch() const override {
    return talk_->hello().has_batch ? attest::max_batch : 0;
  }

  Batched batch(std::span<Sample> samples, std::span<const std::uint64_t> timestamps_us) override {
    batch_.resize(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) batch_[i] = {timestamps_us[i], samples[i]};
    Sample before = samples.front();
    costs_.clear();
    Batched batched;
    batched.result = talk_->batch(number_, info_.module, batch_, batched.done);
    for (std::size_t i = 0; i < batched.done; ++i) {
      samples[i].copy_outputs(batch_[i].sample);
      keep_unpublished(info_.module, before, samples[i]);
      before.copy_outputs(samples[i]);
      if (talk_->hello().cost) costs_.push_back(batch_[i].cost);
    }
    return batched;
  }

  std::span<const StepCost> costs() const override { return costs_; }

 private:
  int answer_to_step() {
    const std::lock_guard lock(talk_->mutex());
    return talk_->step(number_, info_.module, step_);
  }

  Talk talk_;
  std::uint32_t number_;
  const ModuleInfo& info_;
  const Lacks lacks_;
  ProgramStep step_;
  std::vector<ProgramStep> batch_;
  std::vector<StepCost> costs_;
};

class ProgramPort final : public Port {
 public:
  ProgramPort(std::vector<std::string> command, Talk talk)
      : command_(std::move(command)), hello_(talk->hello()), talk_(std::move(talk)) {}

  std::string name() const override { return hello_.name; }
  std::string version() const override { return hello_.version; }
  std::vector<std::string> unsupported_groups() const override { return hello_.unsupported_groups; }
  const Lacks& lacks() const override { return hello_.lacks; }
  std::optional<int> fraction_bits() const override { return hello_.fraction_bits; }
  std::optional<Rate> fixed_step() const override { return hello_.fixed_step; }
  bool is_one_at_a_time() const override { return true; }
  ModuleSet modules() const override { return hello_.modules; }
  std::vector<std::string> files() const override { return hello_.files; }
  std::optional<CostCounter> cost() const override { return hello_.cost; }

  void finish() override { talk_->throw_late(); }

  std::unique_ptr<Unit> create_unit(Module module, const std::string& profile,
                                    const std::string& definition) override {
    const auto& profiles = hello_.profiles;
    if (std::find(profiles.begin(), profiles.end(), profile) == profiles.end()) return nullptr;
    if (talk_->is_over()) start_again();
    const std::uint32_t number = ++units_;
    const int result = talk_->create(number, module, profile, definition);
    if (result == ATTEST_OK) {
      return std::make_unique<ProgramUnit>(talk_, number, module, hello_.lacks);
    }
    if (result == ATTEST_UNSUPPORTED) return nullptr;
    throw PortBroke(
        PortBroke::How::rules,
        fmt::format("the answer to the request `create` has the result {}; it is {} (ok) "
                    "or {} (unsupported)",
                    result, static_cast<int>(ATTEST_OK), static_cast<int>(ATTEST_UNSUPPORTED)));
  }

 private:
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

std::vector<std::string> files_of_program(const std::string& command) {
  const auto words = words_of(command);
  if (!words) return {};
  std::vector<std::string> files;
  if (auto program = find_program(words->front())) files.push_back(*std::move(program));
  for (std::size_t i = 1; i < words->size(); ++i) {
    std::error_code ignored;
    if (std::filesystem::is_regular_file((*words)[i], ignored)) files.push_back((*words)[i]);
  }
  return files;
}

Result<std::unique_ptr<Port>> open_program(const std::string& command) {
  auto words = words_of(command);
  if (!words) return tl::unexpected(words.error());
  if (!find_program(words->front())) {
    return fail_at(words->front(), words->front().find('/') == std::string::npos
                                       ? "no program of this name is in PATH; for a file in "
                                         "this folder, write ./ before its name"
                                       : "is no file that may be executed (chmod +x)");
  }
  auto talk = Conversation::begin(*words);
  if (!talk) return fail_at("proc:" + command, talk.error().message);
  return std::make_unique<ProgramPort>(*std::move(words), Talk(*std::move(talk)));
}

}  // namespace attest
