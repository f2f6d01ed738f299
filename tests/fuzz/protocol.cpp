// All bytes that a program writes (PROTOCOL.md): its handshake, then its answers to the requests
// below, as binary or as text frames. tests/fuzz/seeds.py writes right answers to the same
// requests.
//
// The same bytes have the same result. A wrong answer ends the conversation, with a reason.
#include <array>
#include <cstring>
#include <vector>

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include "harness/port/conversation.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace attest::fuzz {
namespace {

PipedProgram program_that_writes(std::string_view bytes) {
  const int answers = ::memfd_create("answers", MFD_CLOEXEC);
  const auto written = ::write(answers, bytes.data(), bytes.size());
  require(written == static_cast<ssize_t>(bytes.size()), "the answers are written");
  ::lseek(answers, 0, SEEK_SET);
  return PipedProgram::recorded(::open("/dev/null", O_WRONLY | O_CLOEXEC), answers);
}

// What was learned from the answers: results, and the outputs after each step.
using Learned = std::vector<double>;

void learn(const Sample& sample, Learned& learned) {
  for (const Channel& channel : channels()) learned.push_back(value_of(channel, sample));
}

// The requests for a unit of a module.
void use_unit(Conversation& talk, std::uint32_t unit, Module module, Learned& learned) {
  learned.push_back(talk.create(unit, module, "px4-v1.5.5", "R: 4x 10000 10000 10000 0"));
  learned.push_back(talk.set_parameter(unit, "MC_ROLL_P", 6.5f));
  ProgramStep step;
  for (int i = 0; i < 2; ++i) {
    learned.push_back(talk.step(unit, module, step));
    learn(step.sample, learned);
  }
  if (talk.hello().has_batch) {
    std::array<ProgramStep, 3> steps;
    std::size_t done = 0;
    learned.push_back(talk.batch(unit, module, steps, done));
    require(done <= steps.size(), "a batch has no more steps than the request");
    for (std::size_t i = 0; i < done; ++i) learn(steps[i].sample, learned);
  }
  learned.push_back(talk.destroy(unit));
}

Learned talk_with(std::string_view bytes) {
  Learned learned;
  auto begun = Conversation::begin(program_that_writes(bytes));
  if (!begun) {
    require_readable(begun.error().message);
    return learned;
  }
  Conversation& talk = **begun;
  require(!(talk.hello().has_batch && talk.hello().frames == FrameForm::text), "a batch of text");
  try {
    std::uint32_t unit = 0;
    for (const ModuleInfo& info : modules()) {
      if (contains(talk.hello().modules, info.module)) use_unit(talk, ++unit, info.module, learned);
    }
  } catch (const PortBroke& broke) {
    require(talk.is_over(), "no more requests are made after a wrong answer");
    require_readable(broke.what());
  }
  return learned;
}

}  // namespace
}  // namespace attest::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace attest::fuzz;
  const Learned once = talk_with(text_of(data, size));
  const Learned again = talk_with(text_of(data, size));
  // By bits, because a program may answer NaN.
  require(once.size() == again.size() &&
              (once.empty() ||
               std::memcmp(once.data(), again.data(), once.size() * sizeof once[0]) == 0),
          "the same bytes have the same result");
  return 0;
}
